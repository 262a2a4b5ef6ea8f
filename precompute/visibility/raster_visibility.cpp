#include "precompute/visibility/raster_visibility.h"

#include "engine/scene/closed_mesh.h"
#include "engine/vk/result.h"
#include "engine/vk/upload.h"
#include "shaders/visibility_cull_comp.h"
#include "shaders/visibility_cull_reset_comp.h"
#include "shaders/visibility_face_vert.h"
#include "shaders/visibility_frag.h"
#include "shaders/visibility_pack_comp.h"
#include "shaders/visibility_vert.h"

#include <algorithm>
#include <fmt/core.h>
#include <meshoptimizer.h>

namespace relume {

namespace {

constexpr size_t kClusterVertices = 255;

// Margin of horizon clipping, relative to the occluder's radius, so that rounding clips nothing above the
// horizon.
constexpr float kHorizonMargin = 0.01f;

// Added to the cosine of a normal cone, since rounding a corner may flip a triangle that is seen edge-on.
constexpr float kConeMargin = 0.01f;

// Returns the most triangles per cluster: so few that most of them are visible in a face where the cluster's
// box is. With an occluder of 2,000 triangles, clusters of 16 draw a quarter of what those of 256 do. In
// large meshes, many small clusters cost more in draws than they cull.
size_t clusterTriangles(size_t triangles) {
    constexpr size_t kClusters = 128;
    return std::clamp<size_t>(triangles / kClusters / 4 * 4, 16, 128);
}

// Appends triangles, given by their corners, as compact clusters. With backFacesOnly clusters also get a
// normal cone.
void addClusters(const Mesh& mesh, std::span<const uint32_t> corners, bool backFacesOnly,
                 std::vector<shared::TriangleCluster>& clusters, std::vector<uint32_t>& indices) {
    if (corners.empty()) return;
    const float* positions = &mesh.positions[0].x;
    const size_t most = clusterTriangles(mesh.triangleCount());
    const float coneWeight = backFacesOnly ? 0.5f : 0.0f; // weight of similar normals against compactness
    std::vector<meshopt_Meshlet> meshlets(meshopt_buildMeshletsBound(corners.size(), kClusterVertices, most));
    std::vector<unsigned> vertices(meshlets.size() * kClusterVertices);
    std::vector<unsigned char> triangles(meshlets.size() * most * 3);
    meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), triangles.data(), corners.data(),
                                          corners.size(), positions, mesh.vertexCount(), sizeof(vec3),
                                          kClusterVertices, most, coneWeight));
    for (const meshopt_Meshlet& meshlet : meshlets) {
        Bounds box;
        const auto firstIndex = uint32_t(indices.size());
        const uint32_t count = 3 * meshlet.triangle_count;
        for (uint32_t i = 0; i < count; i++) {
            indices.push_back(vertices[meshlet.vertex_offset + triangles[meshlet.triangle_offset + i]]);
            box.add(mesh.positions[indices.back()]);
        }
        shared::TriangleCluster& cluster = clusters.emplace_back();
        cluster = {box.center(), 0.5f * (box.high - box.low), vec3(0), vec3(0), 2, firstIndex, count};
        if (!backFacesOnly) continue;
        // meshoptimizer's cone contains the viewpoints that see only back faces. Reversed triangles give
        // those that see only front faces.
        std::vector<uint32_t> turned(indices.rbegin(), indices.rbegin() + count);
        const meshopt_Bounds cone =
            meshopt_computeClusterBounds(turned.data(), count, positions, mesh.vertexCount(), sizeof(vec3));
        const auto vector = [](const float(&v)[3]) { return vec3(v[0], v[1], v[2]); };
        cluster.apex = vector(cone.cone_apex);
        cluster.axis = vector(cone.cone_axis);
        cluster.cutoff = cone.cone_cutoff + kConeMargin;
    }
}

} // namespace

RasterVisibility::RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size,
                                   uint32_t capacity, float nearDistance)
    : RasterVisibility(device, occluder, size, capacity, nearDistance, Culling::On,
                       device.info().outputsLayers ? Layers::Together : Layers::OneByOne) {}

RasterVisibility::RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size,
                                   uint32_t capacity, float nearDistance, Culling culling, Layers layers)
    : mSize(size), mCapacity(capacity), mIsLayered(layers == Layers::Together),
      mHorizonMargin(std::max(kHorizonMargin * boundsOf(occluder).radius(), nearDistance)),
      mDepthScale(nearDistance / mHorizonMargin) {
    RELUME_CHECK_EQ(size % 32, 0u);
    if (mIsLayered) RELUME_CHECK_LE(6 * capacity, device.info().largestLayerCount);
    createGeometry(device, occluder, culling);
    mLayers = {device, mIsLayered ? uint64_t(mClusterCount) * 6 * capacity * 4 : 4, vk::BufferUse::Device,
               "visibility layers"};
    mBlocked = {device, 6ull * capacity * size * size, vk::BufferUse::Device, "visibility blocked"};
    mTarget = {device,
               {.format = VK_FORMAT_R8_UINT,
                .width = size,
                .height = size,
                .layers = mIsLayered ? 6 * capacity : 1,
                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
               "visibility target"};
    mReset = {device, visibility_cull_reset_comp_spirv, {}, "visibility cull reset"};
    mCull = {device, visibility_cull_comp_spirv, {culling == Culling::On, mIsLayered}, "visibility cull"};
    mPack = {device, visibility_pack_comp_spirv, {size}, "visibility pack"};
    vk::GraphicsOptions options;
    options.colorFormat = VK_FORMAT_R8_UINT;
    const std::span<const uint32_t> vertex =
        mIsLayered ? std::span<const uint32_t>(visibility_vert_spirv) : visibility_face_vert_spirv;
    mDraw = {device, vertex, visibility_frag_spirv, {}, options, "visibility draw"};
    options.cull = vk::Cull::Clockwise; // culls front faces, since the images of a cube's faces are mirrored
    mDrawBackFaces = {device, vertex, visibility_frag_spirv, {}, options, "visibility draw back faces"};
}

Kernels RasterVisibility::kernels() {
    return {visibility_cull_reset_comp_spirv, visibility_cull_comp_spirv, visibility_vert_spirv,
            visibility_face_vert_spirv,       visibility_frag_spirv,      visibility_pack_comp_spirv};
}

void RasterVisibility::createGeometry(const vk::Device& device, const Mesh& occluder, Culling culling) {
    std::vector<uint32_t> indices;
    std::vector<shared::TriangleCluster> clusters;
    std::vector<uint32_t> closed, open;
    const std::vector<bool> isOfClosed = findClosedTriangles(occluder);
    for (size_t t = 0; t < occluder.triangleCount(); t++) {
        const uvec3 triangle = occluder.triangles[t];
        std::vector<uint32_t>& corners = culling == Culling::On && isOfClosed[t] ? closed : open;
        corners.insert(corners.end(), {triangle.x, triangle.y, triangle.z});
    }
    addClusters(occluder, closed, true, clusters, indices);
    mClosedCount = uint32_t(clusters.size());
    addClusters(occluder, open, false, clusters, indices);
    // An empty cluster keeps the passes the same for an empty occluder.
    if (clusters.empty()) clusters.emplace_back();
    mClusterCount = uint32_t(clusters.size());
    const uint64_t ofBatch = mIsLayered ? uint64_t(mClusterCount) * 6 * mCapacity * sizeof(uint32_t)
                                        : drawCount(mCapacity) * sizeof(VkDrawIndexedIndirectCommand);
    if (ofBatch > device.largestStorageBuffer() && mCapacity > 1)
        throw vk::OutOfMemory(fmt::format("visibility draws: {} bytes of {} points are more than {} binds",
                                          ofBatch, mCapacity, device.name()));
    const uint64_t largestBinding = std::max({occluder.vertexCount() * sizeof(vec3), ofBatch,
                                              mClusterCount * sizeof(VkDrawIndexedIndirectCommand)});
    if (largestBinding > device.largestStorageBuffer() ||
        mClusterCount >
            std::min(device.limits().maxComputeWorkGroupCount[1], device.limits().maxDrawIndirectCount))
        throw Error(fmt::format(
            "the occluder's {} triangles are more than {} can take; simplify it: --occluder TRIANGLES",
            occluder.triangleCount(), device.name()));
    mPositions = vk::upload<vec3>(device, occluder.positions, "occluder positions");
    mIndices = vk::upload<uint32_t>(device, indices, "occluder indices");
    mClusters = vk::upload<shared::TriangleCluster>(device, clusters, "occluder clusters");
    mDraws = {device, drawCount(mCapacity) * sizeof(VkDrawIndexedIndirectCommand), vk::BufferUse::Device,
              "visibility draws"};
}

// Draws closed surfaces by their back faces alone: a ray that meets such a surface leaves it through a back
// face, wherever the ray starts.
void RasterVisibility::drawClusters(vk::Commands& commands, std::initializer_list<vk::Binding> bindings,
                                    const shared::VisibilityPush& push, uint64_t firstDraw) const {
    if (mClosedCount > 0) {
        commands.bind(mDrawBackFaces, bindings, push);
        commands.drawIndexedIndirect(mIndices, mDraws, mClosedCount, firstDraw);
    }
    if (mClosedCount < mClusterCount) {
        commands.bind(mDraw, bindings, push);
        commands.drawIndexedIndirect(mIndices, mDraws, mClusterCount - mClosedCount,
                                     firstDraw + mClosedCount);
    }
}

void RasterVisibility::recordTogether(vk::Commands& commands, const vk::Buffer& points,
                                      uint32_t layers) const {
    using enum vk::Stage;
    commands.transition(mTarget, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        Transfer, Color);
    commands.render({.color = &mTarget, .layers = layers}, [&] {
        drawClusters(commands, {points, mPositions, mLayers}, {mHorizonMargin, mDepthScale, 0}, 0);
    });
    commands.transition(mTarget, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, Color, Transfer);
}

void RasterVisibility::recordOneByOne(vk::Commands& commands, const vk::Buffer& points,
                                      uint32_t layers) const {
    using enum vk::Stage;
    commands.barrier(Compute, Transfer);
    for (uint32_t layer = 0; layer < layers; layer++) {
        commands.transition(mTarget, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            Transfer, Color);
        commands.render({.color = &mTarget}, [&] {
            drawClusters(commands, {points, mPositions}, {mHorizonMargin, mDepthScale, layer},
                         uint64_t(layer) * mClusterCount);
        });
        commands.transition(mTarget, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, Color, Transfer);
        commands.copy(mTarget, mBlocked, 1, uint64_t(layer) * mSize * mSize);
    }
}

void RasterVisibility::record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                              const vk::Buffer& bits) const {
    using enum vk::Stage;
    RELUME_CHECK_LE(count, mCapacity);
    const uint32_t layers = 6 * count;
    const shared::CullPush cull{layers, mClusterCount};
    commands.pass("visibility cull", [&] {
        commands.barrier(Draw, Compute);
        if (mIsLayered) {
            commands.dispatch(mReset, {mClusters, mDraws}, cull, {mClusterCount, 1, 1});
            commands.barrier(Compute, Compute);
        }
        commands.dispatch(mCull, {points, mClusters, mDraws, mLayers}, cull, {layers, mClusterCount, 1});
        commands.barrier(Compute, Draw);
    });
    commands.pass("visibility draw", [&] {
        if (mIsLayered)
            recordTogether(commands, points, layers);
        else
            recordOneByOne(commands, points, layers);
    });
    commands.pass("visibility pack", [&] {
        if (mIsLayered) {
            commands.barrier(Compute, Transfer);
            commands.copy(mTarget, mBlocked, layers);
        }
        commands.barrier(Transfer, Compute);
        const auto words = uint32_t(count * visibilityBytes(mSize) / 4);
        commands.dispatch(mPack, {points, mBlocked, bits}, shared::PackVisibilityPush{words}, {words, 1, 1});
    });
}

uint64_t RasterVisibility::drawnTriangles(const vk::Device& device, uint32_t count) const {
    uint64_t triangles = 0;
    for (const auto& draw : vk::download<VkDrawIndexedIndirectCommand>(device, mDraws, drawCount(count)))
        triangles += uint64_t(draw.indexCount / 3) * draw.instanceCount;
    return triangles;
}

} // namespace relume
