// Structs and push constants of the run time's passes: light, relight, view.
#ifndef RELUME_SHADERS_SHARED_RENDER_H
#define RELUME_SHADERS_SHARED_RENDER_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// A pixel of a latlong map in the footprint of a texel of the lighting cube.
struct FootprintPixel {
    uint place; // column, and row << 16
    float weight;
};
RELUME_SHARED_SIZE(FootprintPixel, 8)

struct LightSamplePush {
    uint texels; // of the cube
    uint width;  // of the map
    uint shift;  // columns that the map is turned by, below the width; and the fraction of one
    float fraction;
};
RELUME_SHARED_SIZE(LightSamplePush, 16)

struct LightQuantisePush {
    uint coefficients; // 6 · F²
    uint threshold;    // at least 1
    uint maximum;      // kLightMaximum
    uint sumLimit;     // kLightSumLimit
    uint entryLimit;   // kMaximumLightEntries
};
RELUME_SHARED_SIZE(LightQuantisePush, 20)

// One quantised light coefficient: r and g in the halves of a word (r lowest), b in a word of its own.
struct PackedLight {
    uint redGreen;
    int blue;
};
RELUME_SHARED_SIZE(PackedLight, 8)

// What belongs to all coefficients of a light.
struct LightScale {
    float scale; // coefficient = scale · quantised value
};
RELUME_SHARED_SIZE(LightScale, 4)

struct RelightPush {
    uint firstRow; // of the shard in its part
    uint rows;     // of the shard
};
RELUME_SHARED_SIZE(RelightPush, 8)

struct ViewVertex {
    vec3 position;
    vec3 normal; // Unit length
};
RELUME_SHARED_SIZE(ViewVertex, 24)

struct ViewPush {
    mat4 clipFromWorld;
    vec3 eye;
    uint terms;     // K of the part
    uint firstTerm; // of this draw
    uint mapping;   // of the view maps: DiskMapping
};
RELUME_SHARED_SIZE(ViewPush, 88)

RELUME_SHARED_END

#endif
