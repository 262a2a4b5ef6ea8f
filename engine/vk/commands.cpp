#include "engine/vk/commands.h"

#include "engine/base/check.h"
#include "engine/math/divide_up.h"
#include "engine/vk/result.h"
#include "engine/vk/tick_clock.h"
#include "engine/vk/timing_capture.h"

#include <algorithm>
#include <array>

namespace relume::vk {

namespace {

constexpr uint32_t kSetsPerPool = 256;
constexpr uint32_t kMaxTimedPasses = 512;
constexpr size_t kMostBindings = 32; // per program

// Returns the size of a texel of a buffer.
uint64_t texelBytes(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
        return sizeof(float);
    case VK_FORMAT_R32G32_UINT:
        return 2 * sizeof(float);
    default:
        return 4 * sizeof(float);
    }
}

struct StageMasks {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 reads, writes;
};

StageMasks masksOf(Stage stage) {
    switch (stage) {
    case Stage::Compute:
        return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
    case Stage::Transfer:
        return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_ACCESS_2_TRANSFER_WRITE_BIT};
    case Stage::Color:
        return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT |
                    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
    case Stage::Draw:
        return {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT |
                    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT |
                    VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_SHADER_READ_BIT,
                0};
    default:
        return {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_ACCESS_2_HOST_WRITE_BIT};
    }
}

// Returns the accesses that an image in this layout allows: all in UNDEFINED, whose contents are discarded.
VkAccessFlags2 accessesIn(VkImageLayout layout) {
    switch (layout) {
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
        return VK_ACCESS_2_TRANSFER_READ_BIT;
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
        return VK_ACCESS_2_TRANSFER_WRITE_BIT;
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
        return VK_ACCESS_2_SHADER_READ_BIT;
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
        return VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
        return VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR:
        return 0;
    default:
        return ~VkAccessFlags2(0);
    }
}

// All earlier commands as what a barrier or a timestamp waits for, and all later ones as what waits.
// ALL_COMMANDS means the same, but best-practices validation warns of it wherever it stands.
constexpr VkPipelineStageFlags2 kAllBefore = VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT,
                                kAllAfter = VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT;

} // namespace

Commands::Commands(const Device& device) : mDevice(device) {}

// Delegates, so that the destructor runs if an object cannot be made.
Commands::Commands(const Device& device, std::string_view name) : Commands(device) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.queueFamily();
    mPool = RELUME_VK_CREATE(vkCreateCommandPool, device.handle(), pool);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = mPool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    RELUME_VK(vkAllocateCommandBuffers(device.handle(), &allocate, &mOwnCommands));
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    mFence = RELUME_VK_CREATE(vkCreateFence, device.handle(), fence);
    VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = 2 * kMaxTimedPasses;
    mQueries = RELUME_VK_CREATE(vkCreateQueryPool, device.handle(), queries);
    device.setName(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<uint64_t>(mOwnCommands), name);
    device.setName(VK_OBJECT_TYPE_COMMAND_POOL, reinterpret_cast<uint64_t>(mPool), name);
    device.setName(VK_OBJECT_TYPE_FENCE, reinterpret_cast<uint64_t>(mFence), name);
    device.setName(VK_OBJECT_TYPE_QUERY_POOL, reinterpret_cast<uint64_t>(mQueries), name);
}

Commands::~Commands() {
    dropTexelViews();
    for (VkDescriptorPool pool : mDescriptorPools) vkDestroyDescriptorPool(mDevice.handle(), pool, nullptr);
    vkDestroyQueryPool(mDevice.handle(), mQueries, nullptr);
    vkDestroyFence(mDevice.handle(), mFence, nullptr);
    vkDestroyCommandPool(mDevice.handle(), mPool, nullptr);
}

void Commands::reset() {
    for (VkDescriptorPool pool : mDescriptorPools)
        RELUME_VK(vkResetDescriptorPool(mDevice.handle(), pool, 0));
    mActivePool = 0;
    mAllocatedSets = 0;
    dropTexelViews();
    mTimedPasses.clear();
}

void Commands::begin() {
    reset();
    RELUME_VK(vkResetCommandPool(mDevice.handle(), mPool, 0));
    mCommands = mOwnCommands;
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    RELUME_VK(vkBeginCommandBuffer(mCommands, &begin));
    mIsRecordingTimed = mIsTimed && mDevice.timestampBits() > 0;
    if (mIsRecordingTimed) vkCmdResetQueryPool(mCommands, mQueries, 0, 2 * kMaxTimedPasses);
}

void Commands::begin(VkCommandBuffer hosts) {
    reset();
    mCommands = hosts;
    mIsRecordingTimed = false;
}

void Commands::pass(const char* name, const std::function<void()>& work) {
    const uint32_t query = 2 * uint32_t(mTimedPasses.size());
    const bool timed = mIsRecordingTimed && mTimedPasses.size() < kMaxTimedPasses;
    mDevice.beginLabel(mCommands, name);
    if (timed) {
        mTimedPasses.emplace_back(name);
        vkCmdWriteTimestamp2(mCommands, kAllBefore, mQueries, query);
        orderAllCommands();
    }
    work();
    if (timed) vkCmdWriteTimestamp2(mCommands, kAllBefore, mQueries, query + 1);
    mDevice.endLabel(mCommands);
}

// Orders all later commands after all earlier ones, timestamps included. Otherwise a pass's work may run
// ahead of its first timestamp (lavapipe's always does).
void Commands::orderAllCommands() {
    VkMemoryBarrier2 order{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    order.srcStageMask = kAllBefore;
    order.dstStageMask = kAllAfter;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &order;
    vkCmdPipelineBarrier2(mCommands, &dependency);
}

void Commands::dispatchBytes(const ComputeProgram& program, std::initializer_list<Binding> bindings,
                             std::span<const std::byte> push, uvec3 items) {
    bindBytes(program, VK_PIPELINE_BIND_POINT_COMPUTE, bindings, push);
    uint32_t groups[3];
    for (int axis = 0; axis < 3; axis++) {
        const uint32_t size = program.groupSize()[size_t(axis)];
        groups[axis] = divideUp(items[axis], size);
        RELUME_CHECK_LE(groups[axis], mDevice.limits().maxComputeWorkGroupCount[axis]);
    }
    vkCmdDispatch(mCommands, groups[0], groups[1], groups[2]);
}

void Commands::bindBytes(const Program& program, VkPipelineBindPoint point,
                         std::initializer_list<Binding> bindings, std::span<const std::byte> push) {
    RELUME_CHECK(program.pipeline());
    RELUME_CHECK_EQ(bindings.size(), program.bindings().size());
    // An empty struct has a size of one byte, so programs without push constants accept any size.
    if (program.pushConstantBytes() > 0) RELUME_CHECK_EQ(push.size(), size_t(program.pushConstantBytes()));
    vkCmdBindPipeline(mCommands, point, program.pipeline());
    if (program.pushConstantBytes() > 0)
        vkCmdPushConstants(mCommands, program.layout(), program.stages(), 0, uint32_t(push.size()),
                           push.data());
    if (bindings.size() == 0) return;

    const VkDescriptorSet set = allocateSet(program.setLayout());
    RELUME_CHECK_LE(bindings.size(), kMostBindings);
    std::array<VkDescriptorBufferInfo, kMostBindings> buffers;
    std::array<VkDescriptorImageInfo, kMostBindings> images;
    std::array<VkBufferView, kMostBindings> views;
    std::array<VkWriteDescriptorSet, kMostBindings> writes;
    size_t i = 0;
    auto expected = program.bindings().begin();
    for (const Binding& binding : bindings) {
        VkWriteDescriptorSet& write = writes[i];
        write = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set;
        write.dstBinding = expected->first;
        write.descriptorCount = 1;
        write.descriptorType = expected->second;
        if (expected->second == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
            RELUME_CHECK(binding.texelFormat != VK_FORMAT_UNDEFINED);
            views[i] = texelView(binding);
            write.pTexelBufferView = &views[i];
        } else if (binding.buffer) {
            RELUME_CHECK_EQ(int(expected->second), int(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER));
            RELUME_CHECK_LE(binding.bytes, mDevice.largestStorageBuffer());
            buffers[i] = {binding.buffer->handle(), binding.offset, binding.bytes};
            write.pBufferInfo = &buffers[i];
        } else {
            RELUME_CHECK_EQ(int(expected->second), int(VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER));
            images[i] = {binding.sampler->handle(), binding.image->view(),
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
            write.pImageInfo = &images[i];
        }
        ++expected, ++i;
    }
    vkUpdateDescriptorSets(mDevice.handle(), uint32_t(i), writes.data(), 0, nullptr);
    vkCmdBindDescriptorSets(mCommands, point, program.layout(), 0, 1, &set, 0, nullptr);
}

VkBufferView Commands::texelView(const Binding& binding) {
    VkBufferViewCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    create.buffer = binding.buffer->handle();
    create.format = binding.texelFormat;
    create.offset = binding.offset;
    const uint64_t texel = texelBytes(binding.texelFormat);
    RELUME_CHECK_LE(binding.bytes / texel, mDevice.mostTexels(texel));
    create.range = binding.bytes / texel * texel;
    mTexelViews.reserve(mTexelViews.size() + 1); // nothing may throw between creation and ownership
    return mTexelViews.emplace_back(RELUME_VK_CREATE(vkCreateBufferView, mDevice.handle(), create));
}

void Commands::dropTexelViews() {
    for (VkBufferView view : mTexelViews) vkDestroyBufferView(mDevice.handle(), view, nullptr);
    mTexelViews.clear();
}

VkDescriptorSet Commands::allocateSet(VkDescriptorSetLayout layout) {
    for (;; mActivePool++, mAllocatedSets = 0) {
        if (mAllocatedSets == kSetsPerPool) continue; // full
        if (mActivePool == mDescriptorPools.size()) {
            const VkDescriptorPoolSize sizes[] = {
                {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8 * kSetsPerPool},
                {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * kSetsPerPool},
                {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kSetsPerPool}};
            VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
            create.maxSets = kSetsPerPool;
            create.poolSizeCount = uint32_t(std::size(sizes));
            create.pPoolSizes = sizes;
            mDescriptorPools.reserve(mDescriptorPools.size() + 1); // as in texelView()
            const VkDescriptorPool pool = mDescriptorPools.emplace_back(
                RELUME_VK_CREATE(vkCreateDescriptorPool, mDevice.handle(), create));
            mDevice.setName(VK_OBJECT_TYPE_DESCRIPTOR_POOL, reinterpret_cast<uint64_t>(pool), "descriptors");
        }
        VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        allocate.descriptorPool = mDescriptorPools[mActivePool];
        allocate.descriptorSetCount = 1;
        allocate.pSetLayouts = &layout;
        VkDescriptorSet set;
        const VkResult result = vkAllocateDescriptorSets(mDevice.handle(), &allocate, &set);
        if (result == VK_SUCCESS) {
            mAllocatedSets++;
            return set;
        }
        if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)
            check(result, "vkAllocateDescriptorSets");
    }
}

void Commands::render(const RenderTarget& target, const std::function<void()>& draws) {
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = target.color->view();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    std::copy(target.clear.begin(), target.clear.end(), color.clearValue.color.float32);
    const VkFormat format = target.color->options().format;
    if (format == VK_FORMAT_R8_UINT || format == VK_FORMAT_R32_UINT)
        for (size_t i = 0; i < 4; i++) color.clearValue.color.uint32[i] = uint32_t(target.clear[i]);
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    const ImageOptions& size = target.color->options();
    rendering.renderArea = {{0, 0}, {size.width, size.height}};
    rendering.layerCount = target.layers;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    if (target.depth) {
        depth.imageView = target.depth->view();
        const bool withStencil = hasStencil(target.depth->options().format);
        depth.imageLayout = withStencil ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                        : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        depth.loadOp = target.keepsDepth ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
        depth.storeOp = withStencil ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
        depth.clearValue.depthStencil = {1, 0};
        if (target.firstSamples) {
            depth.resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
            depth.resolveImageView = target.firstSamples->view();
            depth.resolveImageLayout = depth.imageLayout;
            depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        }
        rendering.pDepthAttachment = &depth;
        if (withStencil) rendering.pStencilAttachment = &depth;
    }
    vkCmdBeginRendering(mCommands, &rendering);
    const VkViewport viewport{0, 0, float(size.width), float(size.height), 0, 1};
    vkCmdSetViewport(mCommands, 0, 1, &viewport);
    vkCmdSetScissor(mCommands, 0, 1, &rendering.renderArea);
    draws();
    vkCmdEndRendering(mCommands);
}

void Commands::drawIndexed(const Buffer& indices, uint32_t indexCount, uint32_t instances,
                           uint32_t firstIndex) {
    vkCmdBindIndexBuffer(mCommands, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(mCommands, indexCount, instances, firstIndex, 0, 0);
}

void Commands::setStencil(uint32_t value) {
    vkCmdSetStencilReference(mCommands, VK_STENCIL_FACE_FRONT_AND_BACK, value);
}

void Commands::setPositions(const Buffer& positions) {
    const VkBuffer buffer = positions.handle();
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(mCommands, 0, 1, &buffer, &start);
}

void Commands::draw(uint32_t vertices) { vkCmdDraw(mCommands, vertices, 1, 0, 0); }

void Commands::drawIndexedIndirect(const Buffer& indices, const Buffer& draws, uint32_t drawCount,
                                   uint64_t firstDraw) {
    constexpr uint32_t kStride = sizeof(VkDrawIndexedIndirectCommand);
    vkCmdBindIndexBuffer(mCommands, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexedIndirect(mCommands, draws.handle(), firstDraw * kStride, drawCount, kStride);
}

void Commands::barrier(Stage from, Stage to) {
    const StageMasks source = masksOf(from), target = masksOf(to);
    VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    memory.srcStageMask = source.stages;
    memory.srcAccessMask = source.writes;
    memory.dstStageMask = target.stages;
    memory.dstAccessMask = target.reads;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    vkCmdPipelineBarrier2(mCommands, &dependency);
}

void Commands::transition(const Image& image, VkImageLayout from, VkImageLayout to, Stage before,
                          Stage after) {
    const StageMasks source = masksOf(before), target = masksOf(after);
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = source.stages;
    barrier.srcAccessMask = source.writes & accessesIn(from);
    barrier.dstStageMask = target.stages;
    barrier.dstAccessMask = target.reads & accessesIn(to);
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {image.aspect(), 0, image.options().mips, 0, image.options().layers};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(mCommands, &dependency);
}

void Commands::fill(const Buffer& buffer, uint32_t value) {
    vkCmdFillBuffer(mCommands, buffer.handle(), 0, VK_WHOLE_SIZE, value);
}

void Commands::update(const Buffer& buffer, std::span<const std::byte> bytes) {
    RELUME_CHECK_LE(bytes.size(), buffer.bytes());
    constexpr size_t kMost = 65536; // Vulkan's limit per update
    for (size_t start = 0; start < bytes.size(); start += kMost)
        vkCmdUpdateBuffer(mCommands, buffer.handle(), start, std::min(kMost, bytes.size() - start),
                          bytes.data() + start);
}

void Commands::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t fromOffset,
                    uint64_t toOffset) {
    const VkBufferCopy region{fromOffset, toOffset, bytes};
    vkCmdCopyBuffer(mCommands, from.handle(), to.handle(), 1, &region);
}

static VkBufferImageCopy wholeLayers(const Image& image, uint32_t layers) {
    VkBufferImageCopy region{};
    region.imageSubresource = {image.aspect(), 0, 0, layers};
    region.imageExtent = {image.options().width, image.options().height, 1};
    return region;
}

void Commands::copy(const Buffer& from, const Image& to) {
    const ImageOptions& options = to.options();
    std::vector<VkBufferImageCopy> regions;
    uint64_t texels = 0; // before this level
    for (uint32_t level = 0; level < options.mips; level++) {
        VkBufferImageCopy region = wholeLayers(to, options.layers);
        region.bufferOffset = texels;
        region.imageSubresource.mipLevel = level;
        region.imageExtent = {std::max(options.width >> level, 1u), std::max(options.height >> level, 1u), 1};
        texels += uint64_t(region.imageExtent.width) * region.imageExtent.height * options.layers;
        regions.push_back(region);
    }
    RELUME_CHECK(options.mips == 1 || from.bytes() % texels == 0);
    for (VkBufferImageCopy& region : regions) region.bufferOffset *= from.bytes() / texels;
    vkCmdCopyBufferToImage(mCommands, from.handle(), to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           uint32_t(regions.size()), regions.data());
}

void Commands::copy(const Buffer& from, uint64_t fromOffset, const Image& to, uint32_t layer) {
    VkBufferImageCopy region = wholeLayers(to, 1);
    region.bufferOffset = fromOffset;
    region.imageSubresource.baseArrayLayer = layer;
    vkCmdCopyBufferToImage(mCommands, from.handle(), to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &region);
}

void Commands::copy(const Image& from, const Buffer& to, uint32_t layers, uint64_t toOffset) {
    VkBufferImageCopy region = wholeLayers(from, layers);
    region.bufferOffset = toOffset;
    vkCmdCopyImageToBuffer(mCommands, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1,
                           &region);
}

void Commands::submitAndWait() {
    CpuSpan submission(mCapture, "submit");
    RELUME_CHECK(mCommands == mOwnCommands);
    RELUME_VK(vkEndCommandBuffer(mCommands));
    RELUME_VK(vkResetFences(mDevice.handle(), 1, &mFence));
    VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    buffer.commandBuffer = mCommands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &buffer;
    {
        const auto lock = mDevice.lockQueue();
        RELUME_VK(vkQueueSubmit2(mDevice.queue(), 1, &submit, mFence));
    }
    submission.end();
    CpuSpan waiting(mCapture, "wait");
    const VkResult waited = vkWaitForFences(mDevice.handle(), 1, &mFence, VK_TRUE, UINT64_MAX);
    if (waited != VK_SUCCESS) { // nothing that the device still uses may be destroyed
        const auto lock = mDevice.lockQueue();
        vkQueueWaitIdle(mDevice.queue());
    }
    check(waited, "vkWaitForFences");
    waiting.end();
    collectTimes();
}

void Commands::collectTimes() {
    mReadings.resize(2 * mTimedPasses.size());
    if (mReadings.empty()) return;
    RELUME_VK(vkGetQueryPoolResults(mDevice.handle(), mQueries, 0, uint32_t(mReadings.size()),
                                    mReadings.size() * 8, mReadings.data(), 8,
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    if (mCapture) mCapture->addPasses(mTimedPasses, mReadings);
    for (size_t i = 0; i < mTimedPasses.size(); i++) {
        const double seconds =
            double(ticksBetween(mReadings[2 * i], mReadings[2 * i + 1], mDevice.timestampBits())) *
            double(mDevice.limits().timestampPeriod) * 1e-9;
        addTime(mTimes, mTimedPasses[i], seconds);
    }
}

void addTime(PassTimes& times, const std::string& name, double seconds) {
    const auto entry =
        std::find_if(times.begin(), times.end(), [&](const auto& time) { return time.first == name; });
    if (entry == times.end())
        times.emplace_back(name, seconds);
    else
        entry->second += seconds;
}

double secondsOf(const PassTimes& times, std::string_view prefix) {
    double sum = 0;
    for (const auto& [name, seconds] : times)
        if (name.starts_with(prefix)) sum += seconds;
    return sum;
}

} // namespace relume::vk
