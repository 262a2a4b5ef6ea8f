// The CPU twins of the stages of a direct bake, one vertex at a time; deliberately naive, never optimized.
// The Haar transform between them is haarForwardFaces() (engine/math/haar.h), whose own test inverts it.
#pragma once

#include "engine/light/light_vector.h"
#include "engine/math/tangent_frame.h"
#include "engine/scene/factored_brdf.h"
#include "engine/transport/rows/sparse_transport.h"
#include "precompute/transport/row_packing.h"
#include "precompute/visibility/ray_tracer.h"

#include <array>
#include <vector>

namespace relume {

// Returns 6 · size² values: 1 if the direction through the texel's center is unoccluded and above the horizon
// of `normal` (cubeTexelDirection · normal > 0), else 0. Rays start at `origin`, which is already lifted.
std::vector<uint8_t> visibilityCube(const RayTracer& tracer, vec3 origin, vec3 normal, int size);

// Returns 6 · faceSize² transport values of one term: light map · visibility · cosine · solid angle, summed
// over each lighting texel. Evaluates `samples` (1, 4, 16, …: a square) times per lighting texel, each time
// with the visible fraction of the visibility texels around; samples ≤ (visibilitySize / faceSize)².
std::vector<vec3> transportVector(const std::vector<uint8_t>& visibility, int visibilitySize, int faceSize,
                                  int samples, const FactoredBrdf& brdf, int term, const TangentFrame& frame);

// Returns, ascending, the indices of the `count` nonzero coefficients of largest r² + g² + b²; ties go to the
// lower index.
std::vector<uint16_t> selectLargest(const std::vector<vec3>& coefficients, int count);

// Returns the row of the `selected` coefficients: quantized relative to the largest |component|, without
// zeros.
PackedRow packRow(const std::vector<vec3>& coefficients, const std::vector<uint16_t>& selected);

} // namespace relume
