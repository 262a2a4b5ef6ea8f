// Structs and push constants of what is summed into the lighting cube: engine/light/light.h.
#ifndef RELUME_SHADERS_SHARED_LIGHT_H
#define RELUME_SHADERS_SHARED_LIGHT_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// The least radiance that counts as light, 2^-90: sums and differences of texels that are 0 or more than this
// are normal floats.
const float kLeastRadiance = 8.0779356694631609e-28f;

// A disc on the sphere of directions, as it is averaged over texels: engine/light/cap.h.
struct LightCap {
    vec3 centers[6]; // unit vector, in each face's frame: right, down, forward
    float inner;     // covered up to this distance (of unit vectors) from the center,
    float outer;     // less and less up to this, and not at all beyond
    uint side;       // sub-cells of a texel's side
    float amount;    // of a lamp: its solid angle; of a stroke: its opacity
    vec3 radiance;
};
RELUME_SHARED_SIZE(LightCap, 100)

// The caps that one dispatch looks at, of those in its buffer.
struct LightCapsPush {
    uint sideBits; // log2 F
    uint first;
    uint count;
};
RELUME_SHARED_SIZE(LightCapsPush, 12)

// The day sky, as engine/light/day_sky.h makes it: of the paper's five coefficients and the zenith, the
// components are Y, x and y.
struct LightSky {
    vec3 sun; // where it is brightest; unit length
    vec3 a, b, c, d, e;
    vec3 zenith;   // over the distribution there
    vec3 ground;   // radiance
    uint sideBits; // log2 F; the device's alone
};
RELUME_SHARED_SIZE(LightSky, 100)

struct LightTap {
    uint texel;
    vec3 radiance;
};
RELUME_SHARED_SIZE(LightTap, 16)

struct LightDistantPush {
    uint taps;
};
RELUME_SHARED_SIZE(LightDistantPush, 4)

RELUME_SHARED_END

#endif
