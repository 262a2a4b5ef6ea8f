// Structs and push constants of the light sources that are summed into the lighting cube
// (engine/light/light.h), and of its fill (engine/light/fill_light.h).
#ifndef RELUME_SHADERS_SHARED_LIGHT_H
#define RELUME_SHADERS_SHARED_LIGHT_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// The least radiance that counts as light, 2^-90: sums and differences of texels that are 0 or at least this
// are normal floats.
const float kLeastRadiance = 8.0779356694631609e-28f;

// A disc on the sphere of directions, to be averaged over texels: engine/light/cap.h.
struct LightCap {
    vec3 centers[6]; // unit vector, in each face's frame: right, down, forward
    float inner;     // full coverage up to this distance of unit vectors from the center,
    float outer;     // falling to 0 at this distance
    uint side;       // sub-cells along a texel's side
    float amount;    // a lamp's solid angle, or a stroke's opacity
    vec3 radiance;
};
RELUME_SHARED_SIZE(LightCap, 100)

// The caps that one dispatch processes, of those in its buffer.
struct LightCapsPush {
    uint sideBits; // log2 F
    uint first;
    uint count;
};
RELUME_SHARED_SIZE(LightCapsPush, 12)

// The day sky, as made by engine/light/day_sky.h. Components of Preetham's five coefficients and of the
// zenith are Y, x and y.
struct LightSky {
    vec3 sun; // direction of the brightest point; unit length
    vec3 a, b, c, d, e;
    vec3 zenith;   // divided by the distribution there
    vec3 ground;   // radiance
    uint sideBits; // log2 F; used by the device only
};
RELUME_SHARED_SIZE(LightSky, 100)

// The light of distant lights in one texel (engine/light/distant_light.h).
struct LightTap {
    uint texel;
    vec3 radiance;
};
RELUME_SHARED_SIZE(LightTap, 16)

struct LightDistantPush {
    uint taps;
};
RELUME_SHARED_SIZE(LightDistantPush, 4)

// The fill is the light cut at this many times its mean; lanes that sum the mean.
const float kMostOfMean = 10;
const uint kFillLanes = 128;
const uint kLightParts = 2; // LightPart: the whole light, and its fill

struct LightFillPush {
    uint texels; // of the cube
    float share; // kMostOfMean / texels
};
RELUME_SHARED_SIZE(LightFillPush, 8)

RELUME_SHARED_END

#endif
