// Lists devices and their capabilities.
#include "engine/vk/device_list.h"

#include "engine/vk/result.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume::vk {

namespace {

std::string typeName(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "software";
    default:
        return "other";
    }
}

} // namespace

static std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice physical) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    return families;
}

bool doesGraphicsAndCompute(VkPhysicalDevice physical, uint32_t family) {
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    const auto families = queueFamilies(physical);
    return family < families.size() && (families[family].queueFlags & kNeeded) == kNeeded;
}

std::optional<uint32_t> findQueueFamily(VkPhysicalDevice physical) {
    const auto count = uint32_t(queueFamilies(physical).size());
    for (uint32_t family = 0; family < count; family++)
        if (doesGraphicsAndCompute(physical, family)) return family;
    return std::nullopt;
}

static std::string whyUnsuitable(VkPhysicalDevice physical, uint32_t apiVersion) {
    if (apiVersion < VK_API_VERSION_1_3) return "Vulkan 1.3 is needed";
    if (!findQueueFamily(physical)) return "no queue does both graphics and compute";
    VkPhysicalDeviceVulkan12Features features12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features12};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    constexpr uint32_t kSharedMemory = 20 << 10; // for select.comp, rounded up; Vulkan guarantees only 16 KiB
    if (properties.limits.maxComputeSharedMemorySize < kSharedMemory)
        return "20 KiB of shared memory are needed";
    constexpr uint32_t kStorageBuffers = 9; // for relight_combine.comp, PORTABLE
    if (properties.limits.maxPerStageDescriptorStorageBuffers < kStorageBuffers)
        return "9 storage buffers a shader are needed";
    if (!features12.scalarBlockLayout) return "scalarBlockLayout is needed";
    if (!features.features.multiDrawIndirect) return "multiDrawIndirect is needed";
    if (!features.features.drawIndirectFirstInstance) return "drawIndirectFirstInstance is needed";
    return "";
}

DeviceInfo describeDevice(VkPhysicalDevice physical, uint32_t index) {
    VkPhysicalDeviceVulkan11Properties properties11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
    VkPhysicalDeviceVulkan13Properties properties13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES,
                                                    &properties11};
    VkPhysicalDeviceVulkan12Properties properties12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES,
                                                    &properties13};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &properties12};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    const VkPhysicalDeviceProperties& core = properties.properties;
    DeviceInfo info{};
    info.index = index;
    info.name = core.deviceName;
    info.type = typeName(core.deviceType);
    info.isSoftware = core.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info.driver = fmt::format("{} {}", properties12.driverName, properties12.driverInfo);
    for (uint8_t byte : properties11.deviceUUID) info.uuid += fmt::format("{:02x}", byte);
    info.apiVersion =
        fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(core.apiVersion), VK_API_VERSION_MINOR(core.apiVersion),
                    VK_API_VERSION_PATCH(core.apiVersion));
    info.unsuitable = whyUnsuitable(physical, core.apiVersion);
    for (uint32_t heap = 0; heap < memory.memoryHeapCount; heap++)
        info.largestHeap = std::max<uint64_t>(info.largestHeap, memory.memoryHeaps[heap].size);
    info.largestAllocation = properties11.maxMemoryAllocationSize;
    info.largestStorageBuffer = std::min<uint64_t>(core.limits.maxStorageBufferRange, info.largestAllocation);
    info.largestLayerCount = std::min(core.limits.maxImageArrayLayers, core.limits.maxFramebufferLayers);
    VkPhysicalDeviceVulkan12Features features12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features12};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    info.outputsLayers = features12.shaderOutputLayer;
    info.largestTexelBuffer = core.limits.maxTexelBufferElements;
    info.sharedMemory = core.limits.maxComputeSharedMemorySize;
    info.subgroupSize = properties11.subgroupSize;
    info.subgroupBallot = (properties11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                          (properties11.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT);
    info.subgroupSizeCanBeAskedFor =
        (properties13.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
    return info;
}

bool DeviceInfo::takesPortableShaders() const {
    // Desktop GPUs have as many texels; others have the guaranteed 65,536.
    constexpr uint32_t kUsualTexels = 1u << 26;
    return !hasBallots() || largestTexelBuffer < kUsualTexels;
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance) {
    uint32_t count = 0;
    std::vector<VkPhysicalDevice> devices;
    for (const bool isFilled : {false, true}) {
        devices.resize(count);
        const VkResult listed =
            vkEnumeratePhysicalDevices(instance, &count, isFilled ? devices.data() : nullptr);
        checkMemory(listed, "vkEnumeratePhysicalDevices");
        if (listed != VK_SUCCESS) return {};
    }
    devices.resize(count);
    return devices;
}

std::vector<DeviceInfo> listDevices() {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    create.pApplicationInfo = &application;
    VkInstance instance;
    const VkResult created = vkCreateInstance(&create, nullptr, &instance);
    checkMemory(created, "vkCreateInstance");
    if (created != VK_SUCCESS) return {};
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice physical : physicalDevices(instance))
        infos.push_back(describeDevice(physical, uint32_t(infos.size())));
    vkDestroyInstance(instance, nullptr);
    return infos;
}

} // namespace relume::vk
