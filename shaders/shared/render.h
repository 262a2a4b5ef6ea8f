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
    float gain;
    uint isFirst; // 1: writes the cube; 0: adds to it
};
RELUME_SHARED_SIZE(LightSamplePush, 24)

struct LightQuantizePush {
    uint coefficients; // 6 · F²
    uint sumLimit;     // kLightSumLimit
    uint sideBits;     // log2 F
    uint areaWeighted; // 0 or 1
    uint count;        // of kept entries; 0: by share
    float share;       // of the largest weight that a kept entry has
};
RELUME_SHARED_SIZE(LightQuantizePush, 24)

// One quantized light coefficient: r and g in the halves of a word (r lowest), b in a word of its own.
struct PackedLight {
    uint redGreen;
    int blue;
};
RELUME_SHARED_SIZE(PackedLight, 8)

// What belongs to all coefficients of a light.
struct LightStats {
    float scale;  // coefficient = scale · quantized value; a power of two, or 0
    float energy; // Σ c², in units of scale², of the light before,
    float lost;   // and of what selection and rounding took
    uint kept;    // entries that are not zero
    uint changed; // entries that are not those of the light recorded before, or kUnknownChange
};
RELUME_SHARED_SIZE(LightStats, 20)

// The light before had another scale, or an entry differs by more than 16 bits hold.
const uint kUnknownChange = 0xffffffffu;

// How sums of products with the light are brought up to date: anew; from the changes of the light, where
// these are known; or whichever reads less.
const uint kRelightFull = 0, kRelightIncremental = 1, kRelightAuto = 2;

struct RelightRowsPush {
    uint firstRow; // of the shard in its part
    uint rows;     // of the shard
};
RELUME_SHARED_SIZE(RelightRowsPush, 8)

// What a group of relight_project works on: 16 words, of four components each, of a cluster's columns.
struct BasisGroup {
    uint firstColumn, columns;           // of the cluster
    uint firstBasisWord, wordsPerColumn; // of the cluster
    uint firstWord;                      // of the group, in each column
    uint firstComponent;                 // of the cluster
    uint cluster;                        // in the shard
};
RELUME_SHARED_SIZE(BasisGroup, 28)

struct RelightProjectPush {
    uint mode;  // kRelightFull and so on
    uint stamp; // of this recording
};
RELUME_SHARED_SIZE(RelightProjectPush, 8)

// A cluster as relight_combine sees it.
struct BasisVertices {
    uint firstVertex, vertices; // of the part
    uint firstComponent;
};
RELUME_SHARED_SIZE(BasisVertices, 12)

// The kinds of a term.
struct BasisTermKinds {
    uint first, count;
};
RELUME_SHARED_SIZE(BasisTermKinds, 8)

// A kind's weights in a cluster: of each eight vertices a uvec2 per component.
struct BasisWeighting {
    uint firstWeights; // in uvec2
    uint firstScale, components;
};
RELUME_SHARED_SIZE(BasisWeighting, 12)

struct RelightCombinePush {
    uint terms, kinds;
    uint groupsPerTerm; // of invocations, in a cluster
    uint stamp;         // of this recording
};
RELUME_SHARED_SIZE(RelightCombinePush, 16)

struct ViewVertex {
    vec3 position;
    vec3 normal;  // Unit length
    vec2 uv;      // of the part's textures, if it has any
    vec4 color;   // as paint, if the part is painted by colors
    vec3 tangent; // Unit length if the part has tangents
    float unused;
};
RELUME_SHARED_SIZE(ViewVertex, 64)
const uint kVertexTexels = 4; // of a ViewVertex

// Layers of view maps that a part shows: engine/render/appearance.h.
struct ViewLayer {
    uint firstMap;   // of the layer's K maps in the part's texture
    int channel;     // of the paint that multiplies it; -1: none
    uint isTextured; // 1: the base color texture multiplies it
    float weight;
    uint firstSlot;   // of its lit spheres, by node
    uint harmonics;   // of their view's azimuth
    float mostOfFlat; // times the surface's unshadowed radiance: what normal maps may raise it to
};
RELUME_SHARED_SIZE(ViewLayer, 28)

// The details of a part (engine/scene/surface_detail.h), which come before its layers in their buffer.
struct ViewDetail {
    vec3 emission;     // radiance, times the emission map
    float normalScale; // of the normal map's x and y; 0: there is none
    uint isTinted;     // 1: vertex colors multiply the base color
};
RELUME_SHARED_SIZE(ViewDetail, 20)

// What a draw's fragments look at, the least that serves the materials bound to a part.
const uint kSingleLook = 0;  // one layer and a constant
const uint kLayersLook = 1;  // several layers and constants
const uint kSurfaceLook = 2; // paint, a texture or a detail as well

// How a draw's fragments estimate radiance: shaders/lib/unshadowed.glsl.
const uint kTermsAlone = 0, kResidualDifference = 1, kResidualRatio = 2;
const uint kBounced = 4;    // added to the latter two: light of other surfaces is in the tuples
const uint kUnshadowed = 8; // alone: what nothing shadows is all that is known

// Where a part's paint comes from.
const uint kUnpainted = 0, kPaintedByMap = 1, kPaintedByColors = 2;

struct ViewSurfacePush {
    mat4 clipFromWorld;
    uint firstSurface; // the number of the part's first triangle
};
RELUME_SHARED_SIZE(ViewSurfacePush, 68)

// Positions of a pixel's samples, Vulkan's standard ones: in sixteenths of the pixel, four bits a sample.
const uint kSampleX2 = 0x4cu, kSampleY2 = 0x4cu;
const uint kSampleX4 = 0xa2e6u, kSampleY4 = 0xea62u;
const uint kSampleX8 = 0xfb135d79u, kSampleY8 = 0x1f7d39b5u;

// The pixels that a part may cover, and where they look.
struct ViewRays {
    vec3 eye;
    vec3 corner, right, down; // a pixel's direction: corner + x · right + y · down, not normalized
    vec4 rectangle;           // of these pixels, in clip space: left, top, right, bottom
};
RELUME_SHARED_SIZE(ViewRays, 64)

struct ViewShadePush {
    ViewRays rays;
    uint firstSurface, surfaces;
    uint mapping;   // of the view maps: DiskMapping
    uint firstMap;  // kSingleLook: of the layer,
    float weight;   // and how much of it
    uint layers;    // that are bound
    uint paint;     // kUnpainted, kPaintedByMap or kPaintedByColors
    uint materials; // of the bound set: no more than these share the paint
    uint terms;     // that are summed, the first ones: 1 to K
    // Used by the residual alone:
    uint firstSlot;   // kSingleLook: of the layer
    uint firstTuples; // of the set: images of its unshadowed tuples
    uint firstWeight; // of the set: texels of what weighs tuples to irradiance
    vec4 groundFade;  // of GroundFade: center, inner and outer; outer 0: all of the part is there
};
RELUME_SHARED_SIZE(ViewShadePush, 128)

struct ViewEdgesPush {
    ViewRays rays;
    uint firstSurface, surfaces; // at least one
};
RELUME_SHARED_SIZE(ViewEdgesPush, 72)

// What view_inspect.frag shows, in the order of Inspect.
const uint kInspectWireframe = 1, kInspectNormals = 2, kInspectDensity = 3;

struct ViewInspectPush {
    ViewRays rays;
    uint firstSurface, surfaces;
    uint mode;        // kInspectWireframe and so on
    float medianArea; // of the asset's triangles
};
RELUME_SHARED_SIZE(ViewInspectPush, 80)

// How compare.frag puts two images together, in the order of CompareMode.
const uint kCompareSplit = 0, kCompareDifference = 1;

struct ComparePush {
    uint mode;
    float split; // column that the second image begins at
    float scale; // of differences: 1 is the hottest color
};
RELUME_SHARED_SIZE(ComparePush, 12)

// Tone curves, in the order of ToneCurve.
const uint kToneNone = 0, kToneAces = 1, kToneAgx = 2;

struct DisplayPush {
    vec3 background; // display values
    float scale;     // of radiance, before the curve
};
RELUME_SHARED_SIZE(DisplayPush, 16)

RELUME_SHARED_END

#endif
