// Structs and push constants of the bake's passes.
#ifndef RELUME_SHADERS_SHARED_BAKE_H
#define RELUME_SHADERS_SHARED_BAKE_H
#include "shaders/shared/types.h"

RELUME_SHARED_BEGIN

// A vertex, for the passes of the bake.
struct BakePoint {
    vec3 origin;  // where visibility is taken: the position, lifted along the normal
    vec3 normal;  // unit length
    vec3 tangent; // s of its frame; zero if the frame follows from the normal
};
RELUME_SHARED_SIZE(BakePoint, 36)

// A few neighboring triangles of the occluder: one indirect draw, instanced over the layers it is drawn to.
struct TriangleCluster {
    vec3 center, extent; // bounding box: center, and half its size
    // The cone of normals: a point p with dot(normalize(apex - p), axis) ≥ cutoff sees front faces only. The
    // cutoff is above 1 if front faces must be drawn too.
    vec3 apex, axis;
    float cutoff;
    uint firstIndex, indexCount;
};
RELUME_SHARED_SIZE(TriangleCluster, 60)

struct CullPush {
    uint layers; // 6 × points in the batch
    uint clusters;
};
RELUME_SHARED_SIZE(CullPush, 8)

struct VisibilityPush {
    float horizonMargin; // depth below the point's horizon down to which the occluder is drawn
    float depthScale;    // near distance divided by horizonMargin
    uint layer;          // for visibility_face.vert: 6 × point + face
};
RELUME_SHARED_SIZE(VisibilityPush, 12)

struct PackVisibilityPush {
    uint words; // in the batch: points × 6 × size² / 32
};
RELUME_SHARED_SIZE(PackVisibilityPush, 4)

struct TracePush {
    uint loopTest; // turns of a loop that detects devices that end loops early
};
RELUME_SHARED_SIZE(TracePush, 4)

// One of the eight children of a node of the bounding volume hierarchy. `entry` is what traversal pushes for
// it: a node's number, or kBvhLeaf with the number of triangles - 1 in 5 bits and the first triangle in 26.
struct BvhChild {
    vec3 low;
    uint entry;
    vec3 high; // below `low` if there is no child
    uint unused;
};
RELUME_SHARED_SIZE(BvhChild, 32)
const uint kBvhWidth = 8;
const uint kBvhLeaf = 0x80000000u;
const uint kBvhCountShift = 26;

struct TransportPush {
    uint firstTerm; // first term of this dispatch; its rows are ordered by point, then term
    uint terms;
    uint firstPoint; // of this dispatch
    uint allTerms;   // K, of all dispatches
    uint mapSize;    // S
};
RELUME_SHARED_SIZE(TransportPush, 20)

struct RowsPush {
    uint rows;
    uint kept;     // N, row entries
    uint firstRow; // the row that the coefficients start with
};
RELUME_SHARED_SIZE(RowsPush, 12)

// Energies measured while packing a row: sums of squares over the three channels.
struct RowStatistics {
    float total;     // of all coefficients
    float dropped;   // lost by keeping N
    float quantized; // lost by quantization
};
RELUME_SHARED_SIZE(RowStatistics, 12)

// A surface that lights a vertex, for bounce_gather.comp.
struct SourceHit {
    uint firstRow, rows; // of the sources
    float unit;          // radiance of a step
};
RELUME_SHARED_SIZE(SourceHit, 12)

struct BounceGatherPush {
    uint terms;       // of the rows that are made, per vertex
    uint sourceTerms; // steps per hit
};
RELUME_SHARED_SIZE(BounceGatherPush, 8)

RELUME_SHARED_END

#endif
