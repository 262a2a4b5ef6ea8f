#include "precompute/visibility/traced_visibility.h"

#include "engine/base/error.h"
#include "engine/vk/upload.h"
#include "precompute/visibility/bvh.h"
#include "shaders/visibility_trace_comp.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

namespace {

// Tiles of 32 × 128 rays were the fastest of 32 × 32 to 32 × 256 on lavapipe: 1.54 ms of one core per
// point of the bunny, against 1.82 ms for 32 × 32.
constexpr uint32_t kTileWidth = 32, kTileHeight = 128;

void checkDevice(const vk::Device& device, const Bvh& bvh) {
    static_assert(shared::kBvhWidth == 8); // as DeviceInfo::hasBallots() assumes
    RELUME_CHECK(canUse(device, VisibilityMethod::Traced));
    if (std::max(std::as_bytes(std::span(bvh.children)).size(),
                 std::as_bytes(std::span(bvh.triangles)).size()) > device.largestStorageBuffer())
        throw Error(fmt::format(
            "the occluder's {} triangles are more than {} can take; simplify it: --occluder TRIANGLES",
            bvh.triangles.size(), device.name()));
}

} // namespace

TracedVisibility::TracedVisibility(const vk::Device& device, const Mesh& occluder, uint32_t size) {
    RELUME_CHECK_EQ(size % kTileWidth, 0u);
    const uint32_t tileHeight = std::min(size, kTileHeight);
    mTiles = 6 * (size / kTileWidth) * (size / tileHeight);
    const Bvh bvh = buildBvh(occluder);
    checkDevice(device, bvh);
    mNodes = vk::upload<shared::BvhChild>(device, bvh.children, "occluder hierarchy");
    mTriangles = vk::upload<std::array<vec4, 3>>(device, bvh.triangles, "occluder triangles");
    mUnfinished = {device, 4, vk::BufferUse::Readback, "unfinished tiles"};
    mUnfinished.map<uint32_t>()[0] = 0;
    const uint32_t lanes = device.info().subgroupSize;
    // A popped entry leaves at most kBvhWidth in its place; as many are popped at once as the subgroup has
    // eights of lanes.
    const uint32_t stackSize = bvh.depth * shared::kBvhWidth * (lanes / shared::kBvhWidth) + 1;
    mTrace = {device,
              visibility_trace_comp_spirv,
              {size, tileHeight, stackSize, lanes},
              "visibility trace",
              vk::Subgroups::Full};
}

Kernels TracedVisibility::kernels() { return {visibility_trace_comp_spirv}; }

void TracedVisibility::record(vk::Commands& commands, const vk::Buffer& points, uint32_t count,
                              const vk::Buffer& bits) const {
    constexpr uint32_t kLoopTest = 2; // iterations that a loop must take, hidden from the compiler
    commands.pass("visibility trace", [&] {
        commands.barrier(vk::Stage::Compute, vk::Stage::Compute);
        commands.dispatch(mTrace, {points, mNodes, mTriangles, bits, mUnfinished},
                          shared::TracePush{kLoopTest}, {mTiles * mTrace.groupSize()[0], count, 1});
        commands.barrier(vk::Stage::Compute, vk::Stage::Host);
    });
}

void TracedVisibility::check() const {
    if (mUnfinished.map<uint32_t>()[0] > 0)
        throw Error("the device gave up tracing: too many of the occluder's triangles are in one view; use "
                    "--visibility raster or simplify it: --occluder TRIANGLES");
}

} // namespace relume
