// Structs and push constants of the background: engine/light/background.h.
#ifndef RELUME_SHADERS_SHARED_BACKGROUND_H
#define RELUME_SHADERS_SHARED_BACKGROUND_H
#include "shaders/shared/light.h"

RELUME_SHARED_BEGIN

// A stroke, or the sun.
struct BackgroundDisc {
    vec3 center;  // unit vector
    float inner;  // full coverage up to this distance of unit vectors from the center,
    float outer;  // falling to 0 at this distance; the width of a pixel extends the fade
    float amount; // coverage at the center, in [0, 1]
    vec3 radiance;
};
RELUME_SHARED_SIZE(BackgroundDisc, 36)

struct BackgroundPush {
    vec3 corner, right, down; // a pixel's direction, as in ViewRays, in the frame of the unturned light
    float rotation;           // of the map
    float gain;               // of the map; 0 if there is none
    uint hasSky;
    uint strokes; // number of strokes among the discs; the sun follows them
    float edge;   // width of a central pixel, as a distance of unit vectors
    uint side;    // a pixel is the mean of side × side lookups
};
RELUME_SHARED_SIZE(BackgroundPush, 60)

// The largest BackgroundPush::side.
const uint kMostBackgroundSide = 4;

RELUME_SHARED_END

#endif
