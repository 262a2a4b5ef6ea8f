#version 460
// Traces the rays of one tile of a point's visibility cube together, as a packet. One subgroup per tile.
//
// The packet traverses a hierarchy of boxes from near to far. Eight lanes share a node, a child each: it is skipped
// if it is below the horizon, outside the tile's pyramid, or if all rays that could meet it are blocked already. In a
// leaf each lane takes a triangle and finds, row by row, which rays meet it: a ray (u, v, 1) does if it is on the
// inner side of the three planes through the point and an edge. Two triangles that share an edge compute the same
// border, and both include it, so that no ray slips between them.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shaders/lib/cubemap.glsl"
#include "shaders/lib/horizon.glsl"
#include "shaders/shared/bake.h"

layout(constant_id = 0) const uint kSize = 256;
layout(constant_id = 1) const uint kHeight = 128; // rows of a tile
layout(constant_id = 2) const uint kStackSize = 256;
layout(local_size_x_id = 3) in; // the device's subgroup size: 8 to 64, a multiple of 8

layout(push_constant, scalar) uniform Push { TracePush push; };
layout(binding = 0, scalar) readonly buffer Points { BakePoint points[]; };
layout(binding = 1, std430) readonly buffer Nodes { vec4 children[]; };    // BvhChild: two vectors each
layout(binding = 2, std430) readonly buffer Triangles { vec4 corners[]; }; // three per triangle
layout(binding = 3, scalar) writeonly buffer Visible { uint visible[]; };
layout(binding = 4, scalar) buffer Unfinished { uint unfinished; }; // number of packets that were not traced to the end

const uint kWidth = 32; // rays of a tile's row
const uint kTilesPerRow = kSize / kWidth;
const uint kTilesPerFace = kTilesPerRow * (kSize / kHeight);

shared uint blocked[kHeight]; // a word per row, a bit per ray; set below the horizon too
shared uint stack[kStackSize];

// The tile. All values are uniform in the subgroup.
float gHalfSize; // texels per unit of a face coordinate
uint gFace;
ivec2 gFirst;     // texel
vec2 gLow, gHigh; // borders, in face coordinates
vec3 gOrigin;     // the point and its normal, in face coordinates
vec3 gNormal;
vec3 gSigns; // signs of the swizzled axes

// Return v * kFaceAxes[gFace] without the products that are zero; swizzle() omits the signs.
vec3 swizzle(vec3 v) { return gFace < 2 ? v.zyx : gFace < 4 ? v.xzy : v; }
vec3 toFace(vec3 v) { return swizzle(v) * gSigns; }

// Finds the tile's texels whose centers are between face coordinates, or up to a thousandth of a texel beyond.
void reach(vec2 low, vec2 high, out ivec2 first, out ivec2 last) {
    first = max(ivec2(ceil((max(low, -2) + 1) * gHalfSize - 0.501)) - gFirst, ivec2(0));
    last = min(ivec2(floor((min(high, 2) + 1) * gHalfSize - 0.499)) - gFirst, ivec2(kWidth - 1, kHeight - 1));
}

// Returns the bits of a row's texels from first to last.
uint spanBits(int first, int last) { return (0xffffffffu >> (31 - (last - first))) << first; }

// Returns whether a box can block a ray that is still free.
bool mayBlock(vec3 low, vec3 high) {
    if (!(low.x <= high.x)) return false;
    const vec3 center = toFace(0.5 * (low + high)) - gOrigin;
    vec3 extent = swizzle(0.5 * (high - low));
    extent += 1e-6 * (abs(center) + extent); // a margin, so that rounding leaves nothing out that could block
    const float near = center.z - extent.z, far = center.z + extent.z;
    if (far <= 0) return false;
    if (dot(gNormal, center) + dot(abs(gNormal), extent) <= 0) return false;
    const vec2 insideLow = center.xy - gLow * center.z + extent.xy + abs(gLow) * extent.z;
    const vec2 insideHigh = gHigh * center.z - center.xy + extent.xy + abs(gHigh) * extent.z;
    if (min(min(insideLow.x, insideLow.y), min(insideHigh.x, insideHigh.y)) < 0) return false;
    if (near <= 0) return true;

    const float perNear = 1 / near, perFar = 1 / far;
    const vec2 least = center.xy - extent.xy, most = center.xy + extent.xy;
    ivec2 first, last;
    reach(least * mix(vec2(perNear), vec2(perFar), greaterThan(least, vec2(0))),
          most * mix(vec2(perFar), vec2(perNear), greaterThan(most, vec2(0))), first, last);
    if (first.x > last.x) return false;
    const uint span = spanBits(first.x, last.x);
    for (int row = first.y; row <= last.y; row++)
        if ((blocked[row] & span) != span) return true;
    return false;
}

// Blocks the rays that meet a triangle.
void blockTriangle(uint triangle) {
    const vec3 a = toFace(corners[3 * triangle].xyz) - gOrigin;
    const vec3 b = toFace(corners[3 * triangle + 1].xyz) - gOrigin;
    const vec3 c = toFace(corners[3 * triangle + 2].xyz) - gOrigin;
    if (max(a.z, max(b.z, c.z)) <= 0) return;
    if (max(dot(gNormal, a), max(dot(gNormal, b), dot(gNormal, c))) <= 0) return;

    ivec2 first = ivec2(0), last = ivec2(kWidth - 1, kHeight - 1);
    if (min(a.z, min(b.z, c.z)) > 0) {
        const vec3 perDepth = 1 / vec3(a.z, b.z, c.z);
        const vec2 p = a.xy * perDepth.x, q = b.xy * perDepth.y, r = c.xy * perDepth.z;
        reach(min(p, min(q, r)), max(p, max(q, r)), first, last);
        if (first.x > last.x || first.y > last.y) return;
    }

    // The planes through the point and an edge: x u + y v + z is positive on the inner side. The order of operations
    // makes an edge's plane exactly the negative of itself when its ends are exchanged.
    precise vec3 bc = b.yzx * c.zxy - b.zxy * c.yzx;
    precise vec3 ca = c.yzx * a.zxy - c.zxy * a.yzx;
    precise vec3 ab = a.yzx * b.zxy - a.zxy * b.yzx;
    const float volume = dot(a, bc); // its sign tells which side of the triangle the point is on
    if (volume == 0) return;
    const float side = volume < 0 ? -1 : 1;
    const vec3 x = side * vec3(bc.x, ca.x, ab.x);
    const vec3 y = side * vec3(bc.y, ca.y, ab.y);
    const vec3 z = side * vec3(bc.z, ca.z, ab.z);
    const vec3 scale = -1 / x;
    const bvec3 isUpper = lessThan(x, vec3(0)), isLevel = equal(x, vec3(0));
    for (int row = first.y; row <= last.y; row++) {
        const float v = (float(gFirst.y + row) + 0.5) / gHalfSize - 1;
        precise vec3 rest = y * v + z;
        precise vec3 border = rest * scale; // u where the row crosses the plane
        // A plane parallel to the row includes all of it or nothing.
        const vec3 level = mix(vec3(-2), vec3(2), lessThan(rest, vec3(0)));
        const vec3 lows = mix(mix(border, level, isLevel), vec3(-2), isUpper);
        const vec3 highs = mix(vec3(2), border, isUpper);
        const float low = max(max(lows.x, lows.y), max(lows.z, -2));
        const float high = min(min(highs.x, highs.y), min(highs.z, 2));
        const int begin = max(int(ceil((low + 1) * gHalfSize - 0.5)) - gFirst.x, first.x);
        const int end = min(int(floor((high + 1) * gHalfSize - 0.5)) - gFirst.x, last.x);
        if (begin <= end) atomicOr(blocked[row], spanBits(begin, end));
    }
}

// Returns `mask` with bit i moved to bit i ^ octant.
uint reorder(uint mask, uint octant) {
    if ((octant & 1) != 0) mask = (mask & 0x55) << 1 | (mask & 0xaa) >> 1;
    if ((octant & 2) != 0) mask = (mask & 0x33) << 2 | (mask & 0xcc) >> 2;
    if ((octant & 4) != 0) mask = (mask & 0x0f) << 4 | (mask & 0xf0) >> 4;
    return mask;
}

// Returns the hits among the eight lanes of an entry.
uint hitsOf(uvec4 hits, uint entry) { return (entry < 4 ? hits.x : hits.y) >> 8 * (entry % 4) & 0xff; }

void order() {
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

void main() {
    const uint lane = gl_LocalInvocationID.x, lanes = gl_WorkGroupSize.x;
    const uint point = gl_WorkGroupID.y;
    const uint tile = gl_WorkGroupID.x % kTilesPerFace;
    gFace = gl_WorkGroupID.x / kTilesPerFace;
    gHalfSize = 0.5 * float(kSize);
    gFirst = ivec2(tile % kTilesPerRow * kWidth, tile / kTilesPerRow * kHeight);
    gLow = vec2(gFirst) / gHalfSize - 1;
    gHigh = vec2(gFirst + ivec2(kWidth, kHeight)) / gHalfSize - 1;
    gSigns = vec3[6](vec3(-1, -1, 1), vec3(1, -1, -1), vec3(1), vec3(1, -1, -1), vec3(1, -1, 1), vec3(-1))[gFace];
    gOrigin = toFace(points[point].origin);
    gNormal = toFace(points[point].normal);

    bool anyFree = false;
    for (uint row = lane; row < kHeight; row += lanes) {
        const uint above = aboveHorizon(gNormal, uint(gFirst.x), uint(gFirst.y) + row, kSize);
        blocked[row] = ~above;
        anyFree = anyFree || above != 0;
    }
    if (lane == 0) stack[0] = 0; // the root
    uint top = subgroupBallot(anyFree) != uvec4(0) ? 1 : 0;
    order();

    // Eight lanes take an entry: entry 0 from the top of the stack, entry 1 from below it, and so on.
    const uint slot = lane % kBvhWidth, mine = lane / kBvhWidth, entries = lanes / kBvhWidth;
    const vec3 middle = kFaceAxes[gFace] * vec3(0.5 * (gLow + gHigh), 1);
    const uint octant = uint(middle.x < 0) | uint(middle.y < 0) << 1 | uint(middle.z < 0) << 2;
    while (top > 0) {
        const bool working = mine < top;
        const uint entry = working ? stack[top - 1 - mine] : 0;
        top -= min(top, entries);
        order();
        bool hit = false;
        uint child = 0;
        if (working && (entry & kBvhLeaf) != 0) {
            const uint last = entry >> kBvhCountShift & 31;
            if (slot <= last) blockTriangle((entry & ((1u << kBvhCountShift) - 1)) + slot);
        } else if (working) {
            const uint at = 2 * (entry * kBvhWidth + slot);
            const vec4 low = children[at], high = children[at + 1];
            child = floatBitsToUint(low.w);
            hit = mayBlock(low.xyz, high.xyz);
        }
        // The nearest goes on top: children of entry 0 above those of entry 1, and for each entry the slots in the
        // order of the tile's octant.
        const uvec4 hits = subgroupBallot(hit);
        uint below = 0, all = 0;
        for (uint other = 0; other < entries; other++) {
            const uint count = bitCount(hitsOf(hits, other));
            all += count;
            below += other > mine ? count : 0;
        }
        below += bitCount(reorder(hitsOf(hits, mine), octant) >> ((slot ^ octant) + 1));
        if (hit) stack[top + below] = child;
        top += all;
        order();
    }

    const uint firstWord = ((point * 6 + gFace) * kSize + uint(gFirst.y)) * (kSize / 32) + uint(gFirst.x) / 32;
    for (uint row = lane; row < kHeight; row += lanes) visible[firstWord + row * (kSize / 32)] = ~blocked[row];

    // A device that ends loops after a number of turns would end this one too.
    uint turns = 0;
    for (uint i = 0; i < push.loopTest; i++) turns += i + 1;
    if (top > 0 || turns != push.loopTest * (push.loopTest + 1) / 2) atomicAdd(unfinished, 1);
}
