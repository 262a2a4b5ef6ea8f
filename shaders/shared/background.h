// Structs and push constants of what is seen behind the object: engine/light/background.h.
#ifndef RELUME_SHADERS_SHARED_BACKGROUND_H
#define RELUME_SHADERS_SHARED_BACKGROUND_H
#include "shaders/shared/light.h"

RELUME_SHARED_BEGIN

// A stroke, or the sun.
struct BackgroundDisc {
    vec3 center;  // unit vector
    float inner;  // covered up to this distance (of unit vectors) from the center,
    float outer;  // less and less up to this, and not at all beyond; a pixel's edge comes on top
    float amount; // in its middle, in [0, 1]
    vec3 radiance;
};
RELUME_SHARED_SIZE(BackgroundDisc, 36)

struct BackgroundPush {
    vec3 corner, right, down; // a pixel's direction, as ViewRays has it, in the frame of the unturned light
    float rotation;           // of the map
    float gain;               // of the map; 0: there is none
    uint hasSky;
    uint strokes; // of the discs; the sun comes after them
    float edge;   // of a pixel in the middle, distance of unit vectors
    uint side;    // a pixel is the mean of side × side lookups
};
RELUME_SHARED_SIZE(BackgroundPush, 60)

// Most lookups of a pixel, a side.
const uint kMostBackgroundSide = 4;

RELUME_SHARED_END

#endif
