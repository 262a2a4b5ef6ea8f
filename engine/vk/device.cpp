#include "engine/vk/device.h"

#include "engine/base/check.h"
#include "engine/base/log.h"
#include "engine/vk/device_list.h"
#include "engine/vk/features.h"
#include "engine/vk/pipeline_cache.h"
#include "engine/vk/programs.h"
#include "engine/vk/result.h"
#include "engine/vk/shader_replacement.h"
#include "shaders/portable_shaders.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fmt/core.h>
#include <sstream>

namespace relume::vk {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasLayer(const char* name) {
    uint32_t count = 0;
    RELUME_VK(vkEnumerateInstanceLayerProperties(&count, nullptr));
    std::vector<VkLayerProperties> layers(count);
    RELUME_VK(vkEnumerateInstanceLayerProperties(&count, layers.data()));
    return std::any_of(layers.begin(), layers.end(), [&](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, name) == 0;
    });
}

bool hasExtension(const std::vector<VkExtensionProperties>& extensions, const char* name) {
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, name) == 0;
    });
}

bool hasInstanceExtension(const char* name) {
    uint32_t count = 0;
    RELUME_VK(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    RELUME_VK(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()));
    return hasExtension(extensions, name);
}

std::vector<VkExtensionProperties> extensionsOf(VkPhysicalDevice physical) {
    uint32_t count = 0;
    RELUME_VK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    RELUME_VK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()));
    extensions.resize(count);
    return extensions;
}

// Returns whether the device's clock can be read together with CLOCK_MONOTONIC.
bool canReadClocks(VkInstance instance, VkPhysicalDevice physical) {
    if (!hasExtension(extensionsOf(physical), VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME)) return false;
    const auto domainsOf = reinterpret_cast<PFN_vkGetPhysicalDeviceCalibrateableTimeDomainsEXT>(
        vkGetInstanceProcAddr(instance, "vkGetPhysicalDeviceCalibrateableTimeDomainsEXT"));
    uint32_t count = 0;
    RELUME_VK(domainsOf(physical, &count, nullptr));
    std::vector<VkTimeDomainEXT> domains(count);
    RELUME_VK(domainsOf(physical, &count, domains.data()));
    const auto has = [&](VkTimeDomainEXT domain) {
        return std::find(domains.begin(), domains.end(), domain) != domains.end();
    };
    return has(VK_TIME_DOMAIN_DEVICE_EXT) && has(VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT);
}

// Parses names such as "core,sync,gpu,best" into the validation layer's optional checks.
std::vector<VkValidationFeatureEnableEXT> parseValidation(const std::string& text) {
    std::vector<VkValidationFeatureEnableEXT> enabled;
    std::stringstream stream(text);
    for (std::string word; std::getline(stream, word, ',');) {
        if (word == "core") continue;
        if (word == "sync")
            enabled.push_back(VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT);
        else if (word == "gpu") {
            enabled.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT);
            enabled.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT);
        } else if (word == "best")
            enabled.push_back(VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT);
        else
            throw UsageError(
                fmt::format("--validation: expected some of core, sync, gpu, best; found \"{}\"", word));
    }
    return enabled;
}

int preference(const DeviceInfo& info) {
    if (info.type == "discrete GPU") return 0;
    if (info.type == "integrated GPU") return 1;
    return info.type == "software" ? 3 : 2;
}

bool matches(const DeviceInfo& info, const std::string& select) {
    const bool isIndex = select.size() <= 3 && select.find_first_not_of("0123456789") == std::string::npos;
    if (isIndex) return std::to_string(info.index) == select;
    return info.uuid == select || info.name.find(select) != std::string::npos;
}

} // namespace

VkBool32 onValidationMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT,
                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* device) {
    // The layer warns of checks that it cannot make on a device, which is no fault of the program.
    constexpr std::string_view kDoesWithout = "UNASSIGNED-GPU-Assisted Validation Warning";
    if (data->pMessageIdName && data->pMessageIdName == kDoesWithout) {
        log(LogLevel::Info,
            fmt::format("the validation layer checks less on this device: {}", data->pMessage));
        return VK_FALSE;
    }
    // Best practices also tell of vertex buffers that are still bound when a program that reads none draws:
    // Vulkan has no way to unbind them, and they cost nothing.
    constexpr std::string_view kStillBound = "UNASSIGNED-BestPractices-DrawState-VtxIndexOutOfBounds";
    if (data->pMessageIdName && data->pMessageIdName == kStillBound) return VK_FALSE;
    static_cast<Device*>(device)->mValidationMessages++;
    if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT)
        log(LogLevel::Error, fmt::format("validation: {}", data->pMessage));
    else
        log(LogLevel::Warning, fmt::format("validation: {}", data->pMessage));
    return VK_FALSE;
}

Device::Device(const DeviceOptions& options) {
    try {
        createInstance(options);
        pickPhysicalDevice(options.select, options.leastFeatures);
        createDevice(!options.surfaceExtensions.empty());
        mPipelineCache = std::make_unique<PipelineCache>(mDevice, mProperties, options.pipelineCache);
        mPrograms = std::make_unique<Programs>();
    } catch (...) {
        destroy();
        throw;
    }
}

Device::~Device() { destroy(); }

Device::Device(const HostDevice& host) : mIsHosts(true), mInstance(host.instance), mDevice(host.device) {
    if (!host.instance || !host.physical || !host.device || !host.created || !host.queue)
        throw UsageError(
            "host device: expected instance, physical, device, created and queue to be set; one of "
            "them is null");
    if (!doesGraphicsAndCompute(host.physical, host.queueFamily))
        throw UsageError(fmt::format("host device: queue family {} does not do both graphics and compute",
                                     host.queueFamily));
    mInfo = describeDevice(host.physical, 0);
    std::string missing = mInfo.unsuitable;
    if (missing.empty()) missing = missingFeature(*host.created);
    if (!missing.empty())
        throw NoDeviceError(fmt::format("{}: the host's device cannot be used: {}", mInfo.name, missing));
    setPhysicalDevice(host.physical, host.queueFamily);
    mInfo.outputsLayers = mInfo.outputsLayers && hasFeature(*host.created, "shaderOutputLayer");
    if (!hasFeature(*host.created, "fullDrawIndexUint32"))
        mProperties.limits.maxDrawIndexedIndexValue = (1u << 24) - 1;
    mQueue = host.queue;
    loadDebugUtils();
    mMemoryPool = std::make_unique<MemoryPool>(mDevice);
    mPipelineCache = std::make_unique<PipelineCache>(mDevice, mProperties, std::filesystem::path());
    mPrograms = std::make_unique<Programs>();
}

void Device::destroy() {
    if (mIsHosts) {
        mPrograms.reset();
        mPipelineCache.reset();
        mMemoryPool.reset();
        return;
    }
    if (mDevice) {
        vkDeviceWaitIdle(mDevice);
        mPrograms.reset();
        mPipelineCache.reset();
        mMemoryPool.reset();
        vkDestroyDevice(mDevice, nullptr);
    }
    if (mMessenger) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(mInstance, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(mInstance, mMessenger, nullptr);
    }
    if (mInstance) vkDestroyInstance(mInstance, nullptr);
}

void Device::createInstance(const DeviceOptions& options) {
    const std::string& validation = options.validation;
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "relume";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    create.pApplicationInfo = &application;

    const std::vector<VkValidationFeatureEnableEXT> enabled = parseValidation(validation);
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = uint32_t(enabled.size());
    features.pEnabledValidationFeatures = enabled.data();
    if (!validation.empty()) {
        if (!hasLayer(kValidationLayer))
            throw Error(fmt::format("--validation: the layer {} is not installed; on Debian: apt install "
                                    "vulkan-validationlayers",
                                    kValidationLayer));
        create.enabledLayerCount = 1;
        create.ppEnabledLayerNames = &kValidationLayer;
        create.pNext = &features;
    }
    std::vector<const char*> extensions;
    for (const std::string& extension : options.surfaceExtensions) extensions.push_back(extension.c_str());
    const bool canDebug = !validation.empty() || hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (canDebug) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    create.enabledExtensionCount = uint32_t(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    VkInstance instance;
    const VkResult created = vkCreateInstance(&create, nullptr, &instance);
    checkMemory(created, "vkCreateInstance");
    if (created != VK_SUCCESS)
        throw NoDeviceError("no Vulkan driver was found; on Debian, mesa-vulkan-drivers brings one that runs "
                            "everywhere");
    mInstance = instance;
    if (canDebug) loadDebugUtils();
    if (validation.empty()) return;
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    messenger.pfnUserCallback = onValidationMessage;
    messenger.pUserData = this;
    const auto createMessenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(mInstance, "vkCreateDebugUtilsMessengerEXT"));
    mMessenger = RELUME_VK_CREATE(createMessenger, mInstance, messenger);
}

// Loads the debug functions, which are null without the extension.
void Device::loadDebugUtils() {
    const auto load = [&](const char* name) { return vkGetInstanceProcAddr(mInstance, name); };
    mSetName = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(load("vkSetDebugUtilsObjectNameEXT"));
    mBeginLabel = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(load("vkCmdBeginDebugUtilsLabelEXT"));
    mEndLabel = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(load("vkCmdEndDebugUtilsLabelEXT"));
}

void Device::pickPhysicalDevice(const std::string& select, bool leastFeatures) {
    const std::vector<VkPhysicalDevice> devices = physicalDevices(mInstance);
    if (devices.empty())
        throw NoDeviceError(
            "no Vulkan device was found; on Debian, mesa-vulkan-drivers brings a software one");
    int best = -1;
    std::vector<DeviceInfo> infos;
    for (size_t i = 0; i < devices.size(); i++) {
        const DeviceInfo& info = infos.emplace_back(describeDevice(devices[i], uint32_t(i)));
        if (!select.empty()) {
            if (best < 0 && matches(info, select)) best = int(i);
        } else if (info.unsuitable.empty() &&
                   (best < 0 || preference(info) < preference(infos[size_t(best)])))
            best = int(i);
    }
    if (best < 0 && !select.empty())
        throw NoDeviceError(fmt::format(
            "--device {}: no device has this index, UUID or name; `relume devices` lists them", select));
    if (best < 0)
        throw NoDeviceError(fmt::format("{}: cannot be used: {}; `relume devices` lists all", infos[0].name,
                                        infos[0].unsuitable));
    mInfo = infos[size_t(best)];
    if (!mInfo.unsuitable.empty())
        throw NoDeviceError(
            fmt::format("--device {}: {} cannot be used: {}", select, mInfo.name, mInfo.unsuitable));
    if (leastFeatures) {
        mInfo.outputsLayers = mInfo.subgroupBallot = false;
        mInfo.largestTexelBuffer = 1u << 16;
    }
    const VkPhysicalDevice physical = devices[size_t(best)];
    setPhysicalDevice(physical, *findQueueFamily(physical));
}

void Device::setPhysicalDevice(VkPhysicalDevice physical, uint32_t queueFamily) {
    mPhysical = physical;
    mQueueFamily = queueFamily;
    vkGetPhysicalDeviceProperties(mPhysical, &mProperties);
    vkGetPhysicalDeviceMemoryProperties(mPhysical, &mMemory);
    uint32_t families = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(mPhysical, &families, nullptr);
    std::vector<VkQueueFamilyProperties> properties(families);
    vkGetPhysicalDeviceQueueFamilyProperties(mPhysical, &families, properties.data());
    mTimestampBits = properties[mQueueFamily].timestampValidBits;
}

void Device::createDevice(bool showsImages) {
    Features features;
    enableFeatures(mPhysical, features);
    features.vulkan12.shaderOutputLayer = mInfo.outputsLayers;

    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = mQueueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.chain};
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    std::vector<const char*> extensions;
    const bool hasClocks = canReadClocks(mInstance, mPhysical);
    if (hasClocks) extensions.push_back(VK_EXT_CALIBRATED_TIMESTAMPS_EXTENSION_NAME);
    if (showsImages) {
        if (!hasExtension(extensionsOf(mPhysical), VK_KHR_SWAPCHAIN_EXTENSION_NAME))
            throw NoDeviceError(
                fmt::format("{}: cannot show images in a window; `relume devices` lists others", name()));
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    }
    create.enabledExtensionCount = uint32_t(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    mDevice = RELUME_VK_CREATE(vkCreateDevice, mPhysical, create);
    mMemoryPool = std::make_unique<MemoryPool>(mDevice);
    vkGetDeviceQueue(mDevice, mQueueFamily, 0, &mQueue);
    setName(VK_OBJECT_TYPE_QUEUE, reinterpret_cast<uint64_t>(mQueue), "queue");
    if (hasClocks)
        mReadClocks = reinterpret_cast<PFN_vkGetCalibratedTimestampsEXT>(
            vkGetDeviceProcAddr(mDevice, "vkGetCalibratedTimestampsEXT"));
}

VkPipelineCache Device::pipelineCache() const { return mPipelineCache->handle(); }

void Device::savePipelineCache() const { mPipelineCache->save(); }

std::span<const uint32_t> Device::fitting(std::span<const uint32_t> builtIn) const {
    if (!mInfo.takesPortableShaders()) return builtIn;
    for (const PortableShader& shader : kPortableShaders)
        if (shader.standard.data() == builtIn.data()) return shader.portable;
    return builtIn;
}

std::vector<uint32_t> Device::shader(std::span<const uint32_t> builtIn) const {
    const std::lock_guard lock(mShaderMutex);
    const auto replaced = mReplacedShaders.find(builtIn.data());
    if (replaced != mReplacedShaders.end()) return replaced->second;
    const std::span<const uint32_t> own = fitting(builtIn);
    return {own.begin(), own.end()};
}

size_t Device::replaceShaders(std::span<const ShaderReplacement> replacements) {
    for (const ShaderReplacement& replacement : replacements)
        expectSameInterface(replacement.name, fitting(replacement.builtIn), replacement.spirv);
    size_t changed = 0;
    const std::lock_guard lock(mShaderMutex);
    for (const ShaderReplacement& replacement : replacements) {
        const auto replaced = mReplacedShaders.find(replacement.builtIn.data());
        const bool isNew = replaced == mReplacedShaders.end()
                               ? !std::ranges::equal(fitting(replacement.builtIn), replacement.spirv)
                               : replaced->second != replacement.spirv;
        if (!isNew) continue;
        mReplacedShaders[replacement.builtIn.data()] = replacement.spirv;
        changed++;
    }
    if (changed > 0) mPrograms->clear();
    return changed;
}

uint32_t Device::memoryType(uint32_t typeBits, VkMemoryPropertyFlags properties,
                            VkMemoryPropertyFlags preferred) const {
    for (const VkMemoryPropertyFlags wanted : {properties | preferred, properties})
        for (uint32_t type = 0; type < mMemory.memoryTypeCount; type++)
            if ((typeBits >> type & 1) && (mMemory.memoryTypes[type].propertyFlags & wanted) == wanted)
                return type;
    throw Error(fmt::format("{}: has no memory with the properties {:#x}", name(), properties));
}

void Device::setName(VkObjectType type, uint64_t handle, std::string_view name) const {
    if (!mSetName) return;
    char text[128]; // longer names are cut off: what has just been made must not be lost for want of memory
    std::snprintf(text, sizeof text, "%.*s", int(name.size()), name.data());
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = text;
    mSetName(mDevice, &info);
}

void Device::beginLabel(VkCommandBuffer commands, const char* name) const {
    if (!mBeginLabel) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name;
    mBeginLabel(commands, &label);
}

void Device::endLabel(VkCommandBuffer commands) const {
    if (mEndLabel) mEndLabel(commands);
}

} // namespace relume::vk
