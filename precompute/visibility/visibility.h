// Computes visibility cubes of points, one bit per texel, many points per submission. Implementations:
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

// Returns the near distance for points lifted by `offset`: a thousandth of it.
inline float visibilityNearDistance(float offset) { return 1e-3f * offset; }

// Returns a vertex as the bake's kernels take it, lifted by `offset` along its normal.
inline shared::BakePoint bakePoint(const Mesh& mesh, size_t vertex, float offset) {
    return {mesh.positions[vertex] + offset * mesh.normals[vertex], mesh.normals[vertex],
            mesh.tangents.empty() ? vec3(0) : mesh.tangents[vertex]};
}

// Returns the bytes of one point's bits, for faces of size² texels.
inline uint64_t visibilityBytes(uint32_t size) { return 6ull * size * size / 8; }

// Fills a buffer with 6 · size² bits per point, face by face, row by row; bit i of a word is texel i of its
// 32. A bit is set if the direction through the texel's center is unoccluded and above the point's horizon.
//
// To avoid self-intersection, points are lifted off the surface (visibilityOffset), and what is nearer than
// visibilityNearDistance along a face's axis is ignored. Nothing of a convex object rises above a lifted
// tangent plane, so it stays unshadowed; contact shadows stay attached to within the offset.
class Visibility {
  public:
    virtual ~Visibility() = default;

    // Records the visibility of the first `count` BakePoints into the front of `bits`.
    virtual void record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                        const vk::Buffer& bits) const = 0;

    // Throws Error if the device did not finish. To be called after the submission.
    virtual void check() const {}
};

// The SPIR-V of several kernels.
using Kernels = std::vector<std::span<const uint32_t>>;

// Computes visibility with the rasterizer, or with rays in a compute shader.
enum class VisibilityMethod { Raster, Traced };
std::string_view visibilityMethodName(VisibilityMethod method); // "raster" or "traced"

// Returns whether the device supports a method: every device can rasterize; tracing needs
// DeviceInfo::hasBallots().
bool canUse(const vk::Device& device, VisibilityMethod method);
// Returns `method` if the device supports it, otherwise, with a warning, the other one.
VisibilityMethod usableMethod(const vk::Device& device, VisibilityMethod method);

// Returns all kernels that a method uses.
Kernels visibilityKernels(VisibilityMethod method);

// Prepares a method that the device supports. `size` is a multiple of 32, `capacity` the most points per
// batch. Throws OutOfMemory if a smaller batch might succeed, and Error if the occluder has more triangles
// than the device can bind.
std::unique_ptr<Visibility> makeVisibility(const vk::Device& device, VisibilityMethod method,
                                           const Mesh& occluder, uint32_t size, uint32_t capacity,
                                           float nearDistance);

} // namespace relume
