// Visibility cubes of points: one bit per texel, many points a submission. Implementations:
// raster_visibility, traced_visibility.
#pragma once

#include "engine/scene/mesh.h"
#include "engine/vk/commands.h"
#include "shaders/shared/bake.h"

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace relume {

// The near plane of points lifted by `offset`: a thousandth of it.
inline float visibilityNearDistance(float offset) { return 1e-3f * offset; }

// A mesh's vertex as the bake sees it, lifted by `offset` along its normal.
inline shared::BakePoint bakePoint(const Mesh& mesh, size_t vertex, float offset) {
    return {mesh.positions[vertex] + offset * mesh.normals[vertex], mesh.normals[vertex],
            mesh.tangents.empty() ? vec3(0) : mesh.tangents[vertex]};
}

// Bytes of one point's bits, for faces of size² texels.
inline uint64_t visibilityBytes(uint32_t size) { return 6ull * size * size / 8; }

// Fills a buffer with one bit per texel: 6 · size² bits a point, face after face, row by row, bit i of a
// word being texel i of its 32. A bit is set where the direction through the texel's center is free and above
// the point's horizon.
//
// Self-intersection: points are lifted off the surface (visibilityOffset) and what is nearer than
// visibilityNearDistance along a face's axis is not seen. Nothing of a convex object rises above a lifted
// tangent plane, so it stays unshadowed; contact shadows stay attached to within the offset.
class Visibility {
  public:
    virtual ~Visibility() = default;

    // Records the visibility of the first `count` BakePoints into the front of `bits`.
    virtual void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                        const vk::Buffer& bits) const = 0;

    // After the submission. Throws Error when the device gave up before the end.
    virtual void check() const {}
};

// SPIR-V of some kernels.
using Kernels = std::vector<std::span<const uint32_t>>;

// How visibility is found: by the fixed-function rasterizer or by rays in a compute shader.
enum class VisibilityMethod { Raster, Traced };
std::string_view visibilityMethodName(VisibilityMethod method); // "raster", "traced"

// Returns whether the device can use a method: every device draws, and those with DeviceInfo::hasBallots()
// trace.
bool canUse(const vk::Device& device, VisibilityMethod method);
// Returns the method or, with a warning, the other one where the device cannot use it.
VisibilityMethod usableMethod(const vk::Device& device, VisibilityMethod method);

// All that a method runs.
Kernels visibilityKernels(VisibilityMethod method);

// Makes a method ready that the device can use. `size` is a multiple of 32; at most `capacity` points a
// batch. Throws OutOfMemory when a smaller batch may do, Error when the occluder has more triangles than the
// device can bind.
std::unique_ptr<Visibility> makeVisibility(const vk::Device& device, VisibilityMethod method,
                                           const Mesh& occluder, uint32_t size, uint32_t capacity,
                                           float nearDistance);

} // namespace relume
