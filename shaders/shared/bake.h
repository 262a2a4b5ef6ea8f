// Structs and push constants of the bake's passes.
#ifndef RELUME_SHADERS_SHARED_BAKE_H
#define RELUME_SHADERS_SHARED_BAKE_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// A vertex as the bake sees it.
struct BakePoint {
    vec3 origin;  // Where visibility is taken: the position, lifted along the normal
    vec3 normal;  // Unit length
    vec3 tangent; // s of its frame; 0: the frame follows from the normal
};
RELUME_SHARED_SIZE(BakePoint, 36)

// A few neighboring triangles of the occluder: one indirect draw, instanced over the layers it touches.
struct TriangleCluster {
    vec3 center, extent; // Bounding box: the middle, and half its size
    // Normal cone: a point p where dot(normalize(apex - p), axis) ≥ cutoff sees front faces only. The cutoff
    // is above 1 where front faces are drawn too.
    vec3 apex, axis;
    float cutoff;
    uint firstIndex, indexCount;
};
RELUME_SHARED_SIZE(TriangleCluster, 60)

struct CullPush {
    uint layers; // 6 × points of this batch
    uint clusters;
};
RELUME_SHARED_SIZE(CullPush, 8)

struct VisibilityPush {
    float horizonMargin; // height below the point's horizon down to which the occluder is drawn
    float depthScale;    // near distance over horizonMargin
    uint layer;          // of visibility_face.vert: 6 × point + face
};
RELUME_SHARED_SIZE(VisibilityPush, 12)

struct PackVisibilityPush {
    uint words; // of this batch: points × 6 × size² / 32
};
RELUME_SHARED_SIZE(PackVisibilityPush, 4)

struct TracePush {
    uint loopTest; // turns of a loop that shows whether the device still takes loops seriously
};
RELUME_SHARED_SIZE(TracePush, 4)

// One of the eight children of a node of the bounding volume hierarchy. `entry` is what traversal keeps of
// it: a node's number, or kBvhLeaf with the number of triangles - 1 in five bits and the first of them in 26.
struct BvhChild {
    vec3 low;
    uint entry;
    vec3 high; // Below `low` where there is no child
    uint unused;
};
RELUME_SHARED_SIZE(BvhChild, 32)
const uint kBvhWidth = 8;
const uint kBvhLeaf = 0x80000000u;
const uint kBvhCountShift = 26;

struct TransportPush {
    uint firstTerm; // of this dispatch; its rows are point-major: (point, term of the dispatch)
    uint terms;
    uint firstPoint; // of this dispatch
};
RELUME_SHARED_SIZE(TransportPush, 12)

struct RowsPush {
    uint rows;
    uint kept;     // N
    uint firstRow; // whose coefficients are those of row 0
};
RELUME_SHARED_SIZE(RowsPush, 12)

// What packing measured of a row. Sums of squares over the three channels.
struct RowStatistics {
    float total;     // of all coefficients
    float dropped;   // lost by keeping N
    float quantized; // lost by quantization
};
RELUME_SHARED_SIZE(RowStatistics, 12)

RELUME_SHARED_END

#endif
