#version 460
// Quantizes each row's selected coefficients to 11/11/10 bits against its largest component, and counts those that do
// not become zero. One work-group per row. CPU twin: packRow() in precompute/twins/transport_twin.h.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/haar_block.glsl"
#include "shaders/lib/packing.glsl"
#include "shaders/shared/bake.h"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint kFaceSize = 64; // F

layout(push_constant, scalar) uniform Push { RowsPush push; };
layout(binding = 0, scalar) readonly buffer Coefficients { vec3 coefficients[]; }; // lib/haar_block.glsl
layout(binding = 1, scalar) readonly buffer Selected { uint selected[]; }; // N per row
layout(binding = 2, scalar) readonly buffer SelectedCounts { uint selectedCounts[]; };
layout(binding = 3, scalar) writeonly buffer Values { uint values[]; }; // N per row
layout(binding = 4, scalar) writeonly buffer Counts { uint counts[]; }; // entries that are not zero
layout(binding = 5, scalar) writeonly buffer Scales { float scales[]; };
layout(binding = 6, scalar) buffer Statistics { RowStatistics statistics[]; };

const uint kLanes = 32;
shared float laneFloats[kLanes];
shared float laneErrors[kLanes];
shared uint laneCounts[kLanes];

vec3 coefficient(uint row, uint index) {
    return coefficients[16 * HAAR_BLOCKS(kFaceSize) * row + haarSlot(index, kFaceSize)];
}

void main() {
    const uint lane = gl_LocalInvocationID.x, row = push.firstRow + gl_WorkGroupID.x;
    const uint count = selectedCounts[row];
    const uint firstPlace = row * push.kept;

    float largest = 0;
    for (uint i = lane; i < count; i += kLanes) {
        const vec3 magnitude = abs(coefficient(gl_WorkGroupID.x, selected[firstPlace + i]));
        largest = max(largest, max(magnitude.r, max(magnitude.g, magnitude.b)));
    }
    laneFloats[lane] = largest;
    barrier();
    float scale = 0;
    for (uint i = 0; i < kLanes; i++) scale = max(scale, laneFloats[i]);
    barrier();

    uint entries = 0;
    float energy = 0, error = 0;
    for (uint i = lane; i < count; i += kLanes) {
        const vec3 value = coefficient(gl_WorkGroupID.x, selected[firstPlace + i]);
        const ivec3 q = quantizeCoefficient(value, scale);
        const vec3 difference = value - vec3(q) * (scale / vec3(kCoefficientMaximum));
        values[firstPlace + i] = packCoefficient(q);
        entries += uint(q != ivec3(0));
        energy += dot(value, value);
        error += dot(difference, difference);
    }
    laneCounts[lane] = entries;
    laneFloats[lane] = energy;
    laneErrors[lane] = error;
    barrier();
    if (lane != 0) return;
    for (uint i = 1; i < kLanes; i++) {
        entries += laneCounts[i];
        energy += laneFloats[i];
        error += laneErrors[i];
    }
    counts[row] = entries;
    scales[row] = scale;
    statistics[row].total = energy + statistics[row].dropped;
    statistics[row].quantized = error;
}
