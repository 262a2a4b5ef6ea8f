// Makes Vulkan fail at a chosen call, or lack something: part of a library for LD_PRELOAD, set by environment
// variables.
// RELUME_FAULT_VULKAN           how a call fails: device-memory, host-memory, lost, surface-lost, out-of-date
// RELUME_FAULT_VULKAN_CALL      its number, from 1, among the calls that may fail so; 0: none. A lost device
//                               stays lost. stderr says which function it is, and in the end how many calls
//                               there were
// RELUME_FAULT_VULKAN_FUNCTION  the only function to count and to fail, such as vkQueueSubmit2
// RELUME_FAULT_VULKAN_NULL      if set, a failed call gives null handles, for libraries that use what it left
// RELUME_FAULT_EXTENSION        a device extension to hide
// RELUME_FAULT_TIMESTAMP_BITS   valid bits of every queue's timestamps
#include "tests/support/faults.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <utility>
#include <vulkan/vulkan.h>

using namespace relume::test;

namespace {

std::atomic<int> gVulkanCalls = 0;
std::atomic<bool> gIsLost = false;

// How the functions of Vulkan may fail, as its specification lists for each.
using Results = std::initializer_list<VkResult>;
constexpr Results kMemory = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY};
constexpr Results kDeviceMemory = {VK_ERROR_OUT_OF_DEVICE_MEMORY};
constexpr Results kLost = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_DEVICE_LOST};
constexpr Results kSurface = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                              VK_ERROR_SURFACE_LOST_KHR};
constexpr Results kSwapchain = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                                VK_ERROR_DEVICE_LOST, VK_ERROR_SURFACE_LOST_KHR};
constexpr Results kPresent = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                              VK_ERROR_DEVICE_LOST, VK_ERROR_SURFACE_LOST_KHR, VK_ERROR_OUT_OF_DATE_KHR};

VkResult chosenResult() {
    const char* kind = std::getenv("RELUME_FAULT_VULKAN");
    if (!kind) return VK_SUCCESS;
    constexpr std::pair<const char*, VkResult> kResults[] = {{"device-memory", VK_ERROR_OUT_OF_DEVICE_MEMORY},
                                                             {"host-memory", VK_ERROR_OUT_OF_HOST_MEMORY},
                                                             {"lost", VK_ERROR_DEVICE_LOST},
                                                             {"surface-lost", VK_ERROR_SURFACE_LOST_KHR},
                                                             {"out-of-date", VK_ERROR_OUT_OF_DATE_KHR}};
    for (const auto& [name, result] : kResults)
        if (!std::strcmp(kind, name)) return result;
    std::fprintf(stderr, "faults: %s is none\n", kind);
    std::abort();
}

// Counts a call of Vulkan and returns how it fails: VK_SUCCESS if it does not.
VkResult vulkanFault(const char* function, Results possible) {
    static const VkResult chosen = chosenResult();
    static const char* const only = std::getenv("RELUME_FAULT_VULKAN_FUNCTION");
    if (chosen == VK_SUCCESS || (only && std::strcmp(only, function))) return VK_SUCCESS;
    if (std::find(possible.begin(), possible.end(), chosen) == possible.end()) return VK_SUCCESS;
    if (gIsLost) return chosen;
    if (++gVulkanCalls != number("RELUME_FAULT_VULKAN_CALL")) return VK_SUCCESS;
    gIsLost = chosen == VK_ERROR_DEVICE_LOST;
    std::fprintf(stderr, "faults: %s fails\n", function);
    return chosen;
}

[[gnu::destructor]] void sayCalls() {
    if (std::getenv("RELUME_FAULT_VULKAN")) std::fprintf(stderr, "faults: %d calls\n", int(gVulkanCalls));
}

// Leaves nonsense where a failed call has no result, as Vulkan permits; or null.
template <typename Handle>
void spoil(Handle* handle) {
    std::memset(handle, std::getenv("RELUME_FAULT_VULKAN_NULL") ? 0 : 0xee, sizeof *handle);
}

} // namespace

extern "C" {

// Overrides a function of Vulkan. `onFault` runs where it fails.
#define RELUME_OVERRIDE(function, results, parameters, arguments, onFault)                                   \
    VkResult function parameters {                                                                           \
        static const auto real = next<VkResult parameters>(#function);                                       \
        const VkResult fault = vulkanFault(#function, results);                                              \
        if (fault == VK_SUCCESS) return real arguments;                                                      \
        onFault;                                                                                             \
        return fault;                                                                                        \
    }
#define RELUME_FAIL(function, results, parameters, arguments)                                                \
    RELUME_OVERRIDE(function, results, parameters, arguments, (void)real)
// A function that waits: what a lost device had to do ends in finite time, as Vulkan demands.
#define RELUME_FAIL_WAIT(function, parameters, arguments)                                                    \
    RELUME_OVERRIDE(function, kLost, parameters, arguments, if (gIsLost) real arguments)
// A function that makes an object.
#define RELUME_FAIL_MAKER(function, results, Owner, Info, Object)                                            \
    RELUME_OVERRIDE(function, results,                                                                       \
                    (Owner owner, const Info* info, const VkAllocationCallbacks* callbacks, Object* object), \
                    (owner, info, callbacks, object), spoil(object))
#define RELUME_FAIL_CREATE(Object)                                                                           \
    RELUME_FAIL_MAKER(vkCreate##Object, kMemory, VkDevice, Vk##Object##CreateInfo, Vk##Object)

RELUME_FAIL_CREATE(Buffer)
RELUME_FAIL_CREATE(BufferView)
RELUME_FAIL_CREATE(CommandPool)
RELUME_FAIL_CREATE(DescriptorPool)
RELUME_FAIL_CREATE(DescriptorSetLayout)
RELUME_FAIL_CREATE(Fence)
RELUME_FAIL_CREATE(Framebuffer)
RELUME_FAIL_CREATE(Image)
RELUME_FAIL_CREATE(ImageView)
RELUME_FAIL_CREATE(PipelineCache)
RELUME_FAIL_CREATE(PipelineLayout)
RELUME_FAIL_CREATE(QueryPool)
RELUME_FAIL_CREATE(RenderPass)
RELUME_FAIL_CREATE(Sampler)
RELUME_FAIL_CREATE(ShaderModule)
RELUME_FAIL_MAKER(vkAllocateMemory, kMemory, VkDevice, VkMemoryAllocateInfo, VkDeviceMemory)
RELUME_FAIL_MAKER(vkCreateDevice, kLost, VkPhysicalDevice, VkDeviceCreateInfo, VkDevice)
RELUME_FAIL_MAKER(vkCreateSwapchainKHR, kSwapchain, VkDevice, VkSwapchainCreateInfoKHR, VkSwapchainKHR)
RELUME_OVERRIDE(vkCreateInstance, kMemory,
                (const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks,
                 VkInstance* instance),
                (info, callbacks, instance), spoil(instance))
// Pipelines that cannot be made are null.
RELUME_OVERRIDE(vkCreateComputePipelines, kMemory,
                (VkDevice device, VkPipelineCache cache, uint32_t count,
                 const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* callbacks,
                 VkPipeline* pipelines),
                (device, cache, count, infos, callbacks, pipelines),
                std::fill_n(pipelines, count, VkPipeline(VK_NULL_HANDLE)))
RELUME_OVERRIDE(vkCreateGraphicsPipelines, kMemory,
                (VkDevice device, VkPipelineCache cache, uint32_t count,
                 const VkGraphicsPipelineCreateInfo* infos, const VkAllocationCallbacks* callbacks,
                 VkPipeline* pipelines),
                (device, cache, count, infos, callbacks, pipelines),
                std::fill_n(pipelines, count, VkPipeline(VK_NULL_HANDLE)))
// So are command buffers and descriptor sets.
RELUME_OVERRIDE(vkAllocateCommandBuffers, kMemory,
                (VkDevice device, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers),
                (device, info, buffers),
                std::fill_n(buffers, info->commandBufferCount, VkCommandBuffer(VK_NULL_HANDLE)))
RELUME_OVERRIDE(vkAllocateDescriptorSets, kMemory,
                (VkDevice device, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* sets),
                (device, info, sets),
                std::fill_n(sets, info->descriptorSetCount, VkDescriptorSet(VK_NULL_HANDLE)))

RELUME_FAIL(vkEnumeratePhysicalDevices, kMemory,
            (VkInstance instance, uint32_t* count, VkPhysicalDevice* devices), (instance, count, devices))
RELUME_FAIL(vkEnumerateInstanceExtensionProperties, kMemory,
            (const char* layer, uint32_t* count, VkExtensionProperties* extensions),
            (layer, count, extensions))
RELUME_FAIL(vkEnumerateInstanceLayerProperties, kMemory, (uint32_t * count, VkLayerProperties* layers),
            (count, layers))
RELUME_FAIL(vkMapMemory, kMemory,
            (VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
             VkMemoryMapFlags flags, void** data),
            (device, memory, offset, size, flags, data))
RELUME_FAIL(vkBindBufferMemory, kMemory,
            (VkDevice device, VkBuffer buffer, VkDeviceMemory memory, VkDeviceSize offset),
            (device, buffer, memory, offset))
RELUME_FAIL(vkBindImageMemory, kMemory,
            (VkDevice device, VkImage image, VkDeviceMemory memory, VkDeviceSize offset),
            (device, image, memory, offset))
RELUME_FAIL(vkBeginCommandBuffer, kMemory, (VkCommandBuffer commands, const VkCommandBufferBeginInfo* info),
            (commands, info))
RELUME_FAIL(vkEndCommandBuffer, kMemory, (VkCommandBuffer commands), (commands))
RELUME_FAIL(vkResetCommandPool, kDeviceMemory,
            (VkDevice device, VkCommandPool pool, VkCommandPoolResetFlags flags), (device, pool, flags))
RELUME_FAIL(vkResetFences, kDeviceMemory, (VkDevice device, uint32_t count, const VkFence* fences),
            (device, count, fences))
RELUME_FAIL(vkGetPipelineCacheData, kMemory,
            (VkDevice device, VkPipelineCache cache, size_t* size, void* data), (device, cache, size, data))
RELUME_FAIL(vkQueueSubmit, kLost, (VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence),
            (queue, count, submits, fence))
RELUME_FAIL(vkQueueSubmit2, kLost,
            (VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence),
            (queue, count, submits, fence))
RELUME_FAIL_WAIT(vkWaitForFences,
                 (VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout),
                 (device, count, fences, all, timeout))
RELUME_FAIL_WAIT(vkQueueWaitIdle, (VkQueue queue), (queue))
RELUME_FAIL_WAIT(vkDeviceWaitIdle, (VkDevice device), (device))
RELUME_FAIL_WAIT(vkGetQueryPoolResults,
                 (VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count, size_t size, void* data,
                  VkDeviceSize stride, VkQueryResultFlags flags),
                 (device, pool, first, count, size, data, stride, flags))

RELUME_FAIL(vkGetPhysicalDeviceSurfaceSupportKHR, kSurface,
            (VkPhysicalDevice device, uint32_t family, VkSurfaceKHR surface, VkBool32* isSupported),
            (device, family, surface, isSupported))
RELUME_FAIL(vkGetPhysicalDeviceSurfaceFormatsKHR, kSurface,
            (VkPhysicalDevice device, VkSurfaceKHR surface, uint32_t* count, VkSurfaceFormatKHR* formats),
            (device, surface, count, formats))
RELUME_FAIL(vkGetPhysicalDeviceSurfacePresentModesKHR, kSurface,
            (VkPhysicalDevice device, VkSurfaceKHR surface, uint32_t* count, VkPresentModeKHR* modes),
            (device, surface, count, modes))
RELUME_FAIL(vkGetPhysicalDeviceSurfaceCapabilitiesKHR, kSurface,
            (VkPhysicalDevice device, VkSurfaceKHR surface, VkSurfaceCapabilitiesKHR* capabilities),
            (device, surface, capabilities))
RELUME_FAIL(vkGetSwapchainImagesKHR, kMemory,
            (VkDevice device, VkSwapchainKHR swapchain, uint32_t* count, VkImage* images),
            (device, swapchain, count, images))
RELUME_FAIL(vkAcquireNextImageKHR, kPresent,
            (VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout, VkSemaphore semaphore,
             VkFence fence, uint32_t* image),
            (device, swapchain, timeout, semaphore, fence, image))
RELUME_FAIL(vkQueuePresentKHR, kPresent, (VkQueue queue, const VkPresentInfoKHR* info), (queue, info))

VkResult vkEnumerateDeviceExtensionProperties(VkPhysicalDevice device, const char* layer, uint32_t* count,
                                              VkExtensionProperties* extensions) {
    static const auto real = next<VkResult(VkPhysicalDevice, const char*, uint32_t*, VkExtensionProperties*)>(
        "vkEnumerateDeviceExtensionProperties");
    if (const VkResult fault = vulkanFault("vkEnumerateDeviceExtensionProperties", kMemory)) return fault;
    const VkResult result = real(device, layer, count, extensions);
    const char* missing = std::getenv("RELUME_FAULT_EXTENSION");
    for (uint32_t i = 0; missing && extensions && i < *count; i++)
        if (!std::strcmp(extensions[i].extensionName, missing)) extensions[i] = extensions[--*count];
    return result;
}

void vkGetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice device, uint32_t* count,
                                              VkQueueFamilyProperties* families) {
    static const auto real = next<void(VkPhysicalDevice, uint32_t*, VkQueueFamilyProperties*)>(
        "vkGetPhysicalDeviceQueueFamilyProperties");
    real(device, count, families);
    for (uint32_t i = 0; std::getenv("RELUME_FAULT_TIMESTAMP_BITS") && families && i < *count; i++)
        families[i].timestampValidBits = uint32_t(number("RELUME_FAULT_TIMESTAMP_BITS"));
}

} // extern "C"
