// Structs and push constants of the passes of a frame: light, relighting, view.
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
    uint texels;    // of the cube
    uint width;     // of the map
    uint shift;     // whole columns by which the map is turned, below the width
    float fraction; // fraction of a column by which it is turned further
    float gain;
    uint isFirst; // 1: overwrites the cube; 0: adds to it
};
RELUME_SHARED_SIZE(LightSamplePush, 24)

struct LightQuantizePush {
    uint coefficients; // 6 · F²
    uint sumLimit;     // kLightSumLimit
    uint sideBits;     // log2 F
    uint areaWeighted; // 0 or 1
    uint count;        // of kept entries; 0: select by `share`
    float share;       // of the largest weight that a kept entry has at least
};
RELUME_SHARED_SIZE(LightQuantizePush, 24)

// A light entry: r and g in the halves of a word (r lowest), b in a word of its own.
struct PackedLight {
    uint redGreen;
    int blue;
};
RELUME_SHARED_SIZE(PackedLight, 8)

// Statistics of a light.
struct LightStats {
    float scale;  // coefficient = scale · quantized value; a power of two, or 0
    float energy; // Σ c² before selection, in units of scale²
    float lost;   // the part of `energy` lost by selection and rounding
    uint kept;    // entries that are not zero
    uint changed; // entries that differ from the light recorded before, or kUnknownChange
};
RELUME_SHARED_SIZE(LightStats, 20)

// LightStats::changed if the light before had another scale, or an entry's change does not fit 16 bits.
const uint kUnknownChange = 0xffffffffu;

// How sums of products with the light are updated: in full; from the changes of the light if these are known;
// or by whichever reads less.
const uint kRelightFull = 0, kRelightIncremental = 1, kRelightAuto = 2;

struct RelightRowsPush {
    uint firstRow; // first row of the shard, in its part
    uint rows;     // of the shard
};
RELUME_SHARED_SIZE(RelightRowsPush, 8)

// The work of a work-group of relight_project: 16 words, of four components each, of a cluster's columns.
struct BasisGroup {
    uint firstColumn, columns;           // of the cluster
    uint firstBasisWord, wordsPerColumn; // of the cluster
    uint firstWord;                      // of the work-group, in each column
    uint firstComponent;                 // of the cluster
    uint cluster;                        // number in the shard
};
RELUME_SHARED_SIZE(BasisGroup, 28)

struct RelightProjectPush {
    uint mode;  // kRelightFull and so on
    uint stamp; // number of this recording
};
RELUME_SHARED_SIZE(RelightProjectPush, 8)

// A cluster, for relight_combine.
struct BasisVertices {
    uint firstVertex, vertices; // in the part
    uint firstComponent;
};
RELUME_SHARED_SIZE(BasisVertices, 12)

// The kinds of a term.
struct BasisTermKinds {
    uint first, count;
};
RELUME_SHARED_SIZE(BasisTermKinds, 8)

// A kind's weights in a cluster: for each eight vertices, a uvec2 per component.
struct BasisWeighting {
    uint firstWeights; // in uvec2
    uint firstScale, components;
};
RELUME_SHARED_SIZE(BasisWeighting, 12)

struct RelightCombinePush {
    uint terms, kinds;
    uint groupsPerTerm; // work-groups per cluster and term
    uint stamp;         // number of this recording
};
RELUME_SHARED_SIZE(RelightCombinePush, 16)

struct ViewVertex {
    vec3 position;
    vec3 normal;  // unit length
    vec2 uv;      // for the part's textures, if it has any
    vec4 color;   // paint if the part is painted by colors; tint if it is tinted
    vec3 tangent; // unit length if the part has tangents
    float unused;
};
RELUME_SHARED_SIZE(ViewVertex, 64)
const uint kVertexTexels = 4; // texels per ViewVertex

// A layer of view maps that a part shows: engine/render/appearance.h.
struct ViewLayer {
    uint firstMap;   // first image of the layer in the part's view maps
    int channel;     // channel of the paint that multiplies it; -1: none
    uint isTextured; // 1: the base color multiplies it
    float weight;
    uint firstSlot;   // first of its lit spheres' slots, which are by node
    uint harmonics;   // harmonics of the view's azimuth in its lit spheres
    float mostOfFlat; // factor on the flat surface's unshadowed radiance: normal maps raise it no further
};
RELUME_SHARED_SIZE(ViewLayer, 28)

// The surface detail of a part (engine/scene/surface_detail.h), which precedes its layers in their buffer.
struct ViewDetail {
    vec3 emission;     // radiance; the emission map multiplies it
    float normalScale; // factor on the normal map's x and y; 0 if there is none
    uint isTinted;     // 1: vertex colors multiply the base color
};
RELUME_SHARED_SIZE(ViewDetail, 20)

// The work of a draw's shader: the least that serves the materials bound to a part.
const uint kSingleLook = 0;  // one layer and a constant
const uint kLayersLook = 1;  // several layers and constants
const uint kSurfaceLook = 2; // paint, a texture or a detail as well

// How a draw's shader estimates radiance: shaders/lib/unshadowed.glsl.
const uint kTermsAlone = 0, kResidualDifference = 1, kResidualRatio = 2;
const uint kBounced = 4;       // added to the latter two: tuples include light from other surfaces
const uint kUnshadowed = 8;    // in their place: shows the unshadowed radiance
const uint kShadow = 16;       // added to any: shows the shadow alone (GroundStyle::Shadow)
const uint kDirectShares = 32; // added to kBounced: vertices tell which share of their tuples is direct light
const float kLeastShadow = 0.03; // shadow that is taken for an error of transport

// Ratios add this to every view map, for the case that all of them vanish. Under the key they add the maps'
// mean, too: the key is small, so that all terms see about the same share of it, which their sums tell with
// the smallest error.
const float kLeastView = 1e-4f;

// The source of a part's paint.
const uint kUnpainted = 0, kPaintedByMap = 1, kPaintedByColors = 2;

struct ViewTriangleIdPush {
    mat4 clipFromWorld;
    uint firstTriangleId; // triangle id of the part's first triangle
};
RELUME_SHARED_SIZE(ViewTriangleIdPush, 68)

// Positions of a pixel's samples, Vulkan's standard ones, in sixteenths of the pixel: four bits per sample.
const uint kSampleX2 = 0x4cu, kSampleY2 = 0x4cu;
const uint kSampleX4 = 0xa2e6u, kSampleY4 = 0xea62u;
const uint kSampleX8 = 0xfb135d79u, kSampleY8 = 0x1f7d39b5u;

// The pixels that a part may cover, and their rays.
struct ViewRays {
    vec3 eye;
    vec3 corner, right, down; // a pixel's direction: corner + x · right + y · down, not normalized
    vec4 rectangle;           // the pixels, in normalized device coordinates: left, top, right, bottom
};
RELUME_SHARED_SIZE(ViewRays, 64)

struct ViewShadePush {
    ViewRays rays;
    uint firstTriangleId, triangleCount;
    uint mapping;   // of the view maps: DiskMapping
    uint firstMap;  // kSingleLook: ViewLayer::firstMap of the layer
    float weight;   // kSingleLook: weight of the layer
    uint layers;    // number of bound layers
    uint paint;     // kUnpainted, kPaintedByMap or kPaintedByColors
    uint materials; // of the bound set: only these share the paint
    uint terms;     // the first terms, 1 to K, that are summed
    // For the residual:
    uint firstSlot;   // kSingleLook: ViewLayer::firstSlot of the layer
    uint firstTuples; // first image of the set's unshadowed tuples, and first texel of its irradiance weights
    uint fillSlots;   // number of slots before those of the fill
    vec4 groundFade;  // GroundFade: center, inner and outer; outer 0: no fade
};
RELUME_SHARED_SIZE(ViewShadePush, 128)

struct ViewEdgesPush {
    ViewRays rays;
    uint firstTriangleId, triangleCount; // at least one
};
RELUME_SHARED_SIZE(ViewEdgesPush, 72)

// The modes of view_inspect.frag, in the order of Inspect.
const uint kInspectWireframe = 1, kInspectNormals = 2, kInspectDensity = 3;

struct ViewInspectPush {
    ViewRays rays;
    uint firstTriangleId, triangleCount;
    uint mode;        // kInspectWireframe and so on
    float medianArea; // of the asset's triangles
};
RELUME_SHARED_SIZE(ViewInspectPush, 80)

// How compare.frag combines two images, in the order of CompareMode.
const uint kCompareSplit = 0, kCompareDifference = 1;

struct ComparePush {
    uint mode;
    float split; // first column of the second image
    float scale; // factor on differences; 1 is the hottest color
};
RELUME_SHARED_SIZE(ComparePush, 12)

// Tone curves, in the order of ToneCurve.
const uint kToneNone = 0, kToneAces = 1, kToneAgx = 2;

struct DisplayPush {
    vec3 background; // display values
    float scale;     // factor on radiance before the curve
};
RELUME_SHARED_SIZE(DisplayPush, 16)

RELUME_SHARED_END

#endif
