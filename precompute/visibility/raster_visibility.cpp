#include "precompute/visibility/raster_visibility.h"

#include "engine/vk/result.h"
#include "engine/vk/upload.h"
#include "shaders/visibility_cull_comp.h"
#include "shaders/visibility_cull_reset_comp.h"
#include "shaders/visibility_face_vert.h"
#include "shaders/visibility_frag.h"
#include "shaders/visibility_pack_comp.h"
#include "shaders/visibility_vert.h"

#include <algorithm>
#include <meshoptimizer.h>

namespace relume {

namespace {

constexpr size_t kClusterVertices = 255;

// Few enough that most of a cluster shows in a face where its sphere does: with an occluder of 2,000
// triangles a point of the bunny draws 1,400 over its faces in clusters of 16, and 5,500 in clusters of 256.
// Many small clusters of large meshes cost more in draws than they leave out.
size_t clusterTriangles(size_t triangles) {
    constexpr size_t kClusters = 128;
    return std::clamp<size_t>(triangles / kClusters / 4 * 4, 16, 128);
}

// Groups the occluder's triangles into compact clusters; `indices` receives their corners, cluster by
// cluster.
std::vector<shared::TriangleCluster> makeClusters(const Mesh& mesh, std::vector<uint32_t>& indices) {
    const auto* corners = &mesh.triangles[0].x;
    const auto* positions = &mesh.positions[0].x;
    const size_t indexCount = 3 * mesh.triangleCount(), most = clusterTriangles(mesh.triangleCount());
    std::vector<meshopt_Meshlet> meshlets(meshopt_buildMeshletsBound(indexCount, kClusterVertices, most));
    std::vector<unsigned> vertices(meshlets.size() * kClusterVertices);
    std::vector<unsigned char> triangles(meshlets.size() * most * 3);
    meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), triangles.data(), corners,
                                          indexCount, positions, mesh.vertexCount(), sizeof(vec3),
                                          kClusterVertices, most, 0.0f));
    std::vector<shared::TriangleCluster> clusters;
    for (const meshopt_Meshlet& meshlet : meshlets) {
        Bounds box;
        const auto firstIndex = uint32_t(indices.size());
        for (unsigned i = 0; i < 3 * meshlet.triangle_count; i++) {
            indices.push_back(vertices[meshlet.vertex_offset + triangles[meshlet.triangle_offset + i]]);
            box.add(mesh.positions[indices.back()]);
        }
        // A sphere about the box's centre, grown a little so that rounding never culls what it should not.
        float radius = 0;
        for (size_t i = firstIndex; i < indices.size(); i++)
            radius = std::max(radius, glm::length(mesh.positions[indices[i]] - box.centre()));
        clusters.push_back({box.centre(), radius * 1.0001f, firstIndex, 3 * meshlet.triangle_count});
    }
    return clusters;
}

} // namespace

RasterVisibility::RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size,
                                   uint32_t capacity, float nearDistance)
    : RasterVisibility(device, occluder, size, capacity, nearDistance, Culling::On,
                       device.info().outputsLayers ? Layers::Together : Layers::OneByOne) {}

RasterVisibility::RasterVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size,
                                   uint32_t capacity, float nearDistance, Culling culling, Layers layers)
    : mSize(size), mCapacity(capacity), mIsLayered(layers == Layers::Together), mNearDistance(nearDistance) {
    RELUME_CHECK_EQ(size % 32, 0u);
    if (mIsLayered) RELUME_CHECK_LE(6 * capacity, device.info().largestLayerCount);
    createGeometry(device, occluder);
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
    if (mIsLayered)
        mDraw = {device, visibility_vert_spirv, visibility_frag_spirv, {}, options, "visibility draw"};
    else
        mDraw = {device, visibility_face_vert_spirv, visibility_frag_spirv, {}, options, "visibility draw"};
}

Kernels RasterVisibility::kernels() {
    return {visibility_cull_reset_comp_spirv, visibility_cull_comp_spirv, visibility_vert_spirv,
            visibility_face_vert_spirv,       visibility_frag_spirv,      visibility_pack_comp_spirv};
}

void RasterVisibility::createGeometry(const vk::Device& device, const Mesh& occluder) {
    std::vector<uint32_t> indices;
    std::vector<shared::TriangleCluster> clusters;
    if (occluder.triangleCount() > 0) clusters = makeClusters(occluder, indices);
    // A cluster without triangles keeps the passes the same for an empty occluder.
    else
        clusters.push_back({vec3(0), 0, 0, 0});
    mClusterCount = uint32_t(clusters.size());
    const uint64_t ofBatch = mIsLayered ? uint64_t(mClusterCount) * 6 * mCapacity * sizeof(uint32_t)
                                        : drawCount(mCapacity) * sizeof(VkDrawIndexedIndirectCommand);
    if (ofBatch > device.largestStorageBuffer() && mCapacity > 1)
        throw vk::OutOfMemory("visibility draws: {} bytes of {} points are more than {} binds", ofBatch,
                              mCapacity, device.name());
    const uint64_t largestBinding = std::max({occluder.vertexCount() * sizeof(vec3), ofBatch,
                                              mClusterCount * sizeof(VkDrawIndexedIndirectCommand)});
    if (largestBinding > device.largestStorageBuffer() ||
        mClusterCount >
            std::min(device.limits().maxComputeWorkGroupCount[1], device.limits().maxDrawIndirectCount))
        throw Error(
            "the occluder's {} triangles are more than {} can take; simplify it: --occluder TRIANGLES",
            occluder.triangleCount(), device.name());
    mPositions = vk::upload<vec3>(device, occluder.positions, "occluder positions");
    mIndices = vk::upload<uint32_t>(device, indices, "occluder indices");
    mClusters = vk::upload<shared::TriangleCluster>(device, clusters, "occluder clusters");
    mDraws = {device, drawCount(mCapacity) * sizeof(VkDrawIndexedIndirectCommand), vk::BufferUse::Device,
              "visibility draws"};
}

void RasterVisibility::recordTogether(vk::Commands& commands, const vk::Buffer& points,
                                      uint32_t layers) const {
    using enum vk::Stage;
    commands.transition(mTarget, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        Transfer, Color);
    commands.render({.color = &mTarget, .layers = layers}, [&] {
        commands.bind(mDraw, {points, mPositions, mLayers}, shared::VisibilityPush{mNearDistance, 0});
        commands.drawIndexedIndirect(mIndices, mDraws, mClusterCount);
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
            commands.bind(mDraw, {points, mPositions}, shared::VisibilityPush{mNearDistance, layer});
            commands.drawIndexedIndirect(mIndices, mDraws, mClusterCount, uint64_t(layer) * mClusterCount);
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
