// Each kind of validation reports a fault that is planted for it, and nothing without it: the silence that
// all other tests demand means something.
#include "engine/vk/commands.h"
#include "tests/support/log_capture.h"

#include <doctest/doctest.h>
#include <functional>

#ifdef RELUME_GLSLANG
#include "apps/viewer/shader_compiler.h"
#include "tests/support/temporary_folder.h"
#endif

using namespace relume;
using namespace relume::test;

namespace {

using Work = std::function<void(const vk::Device&, bool isFaulty)>;

// Does the work on a device under these checks, without the fault and with it. `sign` is part of the message
// that the fault must have.
void checkReports(const std::string& validation, const std::string& sign, const Work& work) {
    for (const bool isFaulty : {false, true}) {
        CAPTURE(validation);
        CAPTURE(isFaulty);
        const LogCapture log;
        work(vk::Device({.validation = validation}),
             isFaulty); // destroying the device may say something, too
        CAPTURE(log.text());
        CHECK_EQ(log.says("validation: "), isFaulty);
        CHECK_EQ(log.says(sign), isFaulty);
    }
}

constexpr uint32_t kValues = 64;

vk::Buffer values(const vk::Device& device) {
    return {device, kValues * sizeof(uint32_t), vk::BufferUse::Device, "values"};
}

#ifdef RELUME_GLSLANG
vk::ComputeProgram makeProgram(const vk::Device& device, const std::string& buffers,
                               const std::string& work) {
    const TemporaryFolder folder;
    const auto source =
        folder.write("planted.comp", "#version 460\n"
                                     "layout(local_size_x = 64) in;\n" +
                                         buffers +
                                         "layout(push_constant) uniform Push { uint count; };\n"
                                         "void main() {\n"
                                         "    const uint i = gl_GlobalInvocationID.x;\n"
                                         "    if (i < count) " +
                                         work + ";\n}\n");
    return {device, compileShader(source), {}, "planted"};
}

// Writes the first values of a buffer.
vk::ComputeProgram makeWriter(const vk::Device& device) {
    return makeProgram(device, "layout(binding = 0) buffer Values { uint values[]; };\n", "values[i] = i");
}

// Reads the first values of a buffer, and writes them to another.
vk::ComputeProgram makeReader(const vk::Device& device) {
    return makeProgram(device,
                       "layout(binding = 0) readonly buffer From { uint from[]; };\n"
                       "layout(binding = 1) writeonly buffer To { uint to[]; };\n",
                       "to[i] = from[i]");
}
#endif

} // namespace

TEST_CASE("planted validation: core reports a copy to an image in another layout") {
    checkReports("core", "vkCmdCopyBufferToImage", [](const vk::Device& device, bool isFaulty) {
        const vk::Image image(device, {.format = VK_FORMAT_R32_UINT, .width = 8, .height = 8}, "image");
        const vk::Buffer texels = values(device);
        vk::Commands commands(device, "copy");
        commands.begin();
        commands.fill(texels, 1);
        commands.barrier(vk::Stage::Transfer, vk::Stage::Transfer);
        commands.transition(image, VK_IMAGE_LAYOUT_UNDEFINED,
                            isFaulty ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
                                     : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                            vk::Stage::Transfer, vk::Stage::Transfer);
        commands.copy(texels, image);
        commands.submitAndWait();
    });
}

TEST_CASE("planted validation: core reports an object that is left") {
    checkReports("core", "vkDestroyDevice", [](const vk::Device& device, bool isFaulty) {
        VkFence fence = VK_NULL_HANDLE;
        const VkFenceCreateInfo create{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        REQUIRE_EQ(vkCreateFence(device.handle(), &create, nullptr, &fence), VK_SUCCESS);
        if (!isFaulty) vkDestroyFence(device.handle(), fence, nullptr);
    });
}

// The layer (1.3.239) does not report two dispatches that both write a buffer.
TEST_CASE("planted validation: synchronization reports a dispatch that reads what one before it writes") {
#ifdef RELUME_GLSLANG
    checkReports("sync", "SYNC-HAZARD-READ-AFTER-WRITE", [](const vk::Device& device, bool isFaulty) {
        const vk::ComputeProgram writer = makeWriter(device), reader = makeReader(device);
        const vk::Buffer from = values(device), to = values(device);
        vk::Commands commands(device, "dispatches");
        commands.begin();
        commands.dispatch(writer, {from}, kValues, {kValues, 1, 1});
        if (!isFaulty) commands.barrier(vk::Stage::Compute, vk::Stage::Compute);
        commands.dispatch(reader, {from, to}, kValues, {kValues, 1, 1});
        commands.submitAndWait();
    });
#else
    MESSAGE("skipped: this build has no shader compiler");
#endif
}

TEST_CASE("planted validation: GPU assistance reports a shader that writes beyond its buffer") {
#ifdef RELUME_GLSLANG
    checkReports("gpu", "out of bounds", [](const vk::Device& device, bool isFaulty) {
        const vk::ComputeProgram writer = makeWriter(device);
        const vk::Buffer buffer = values(device);
        vk::Commands commands(device, "dispatch");
        commands.begin();
        commands.dispatch(writer, {buffer}, isFaulty ? kValues + 1 : kValues, {kValues + 1, 1, 1});
        commands.submitAndWait();
    });
#else
    MESSAGE("skipped: this build has no shader compiler");
#endif
}

#ifndef RELUME_SANITIZE // with which every buffer has an allocation of its own
TEST_CASE("planted validation: best practices report a small allocation of its own") {
    checkReports("best", "small-dedicated-allocation", [](const vk::Device& device, bool isFaulty) {
        VkMemoryRequirements requirements;
        const vk::Buffer pooled = values(device);
        if (!isFaulty) return;
        VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        create.size = 1024;
        create.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        VkBuffer buffer = VK_NULL_HANDLE;
        REQUIRE_EQ(vkCreateBuffer(device.handle(), &create, nullptr, &buffer), VK_SUCCESS);
        vkGetBufferMemoryRequirements(device.handle(), buffer, &requirements);
        VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        allocate.allocationSize = requirements.size;
        allocate.memoryTypeIndex =
            device.memoryType(requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        VkDeviceMemory memory = VK_NULL_HANDLE;
        REQUIRE_EQ(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory), VK_SUCCESS);
        REQUIRE_EQ(vkBindBufferMemory(device.handle(), buffer, memory, 0), VK_SUCCESS);
        vkDestroyBuffer(device.handle(), buffer, nullptr);
        vkFreeMemory(device.handle(), memory, nullptr);
    });
}
#endif
