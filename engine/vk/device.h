// A Vulkan 1.3 device with one queue for everything.
#pragma once

#include "engine/vk/memory.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <vulkan/vulkan.h>

namespace relume::vk {

class Programs;
class PipelineCache;
struct ShaderReplacement;

// Properties of a Vulkan device, as `relume devices` shows them.
struct DeviceInfo {
    uint32_t index;
    std::string name;
    bool isSoftware;
    std::string type; // "discrete GPU", "integrated GPU", "software", …
    std::string driver;
    std::string uuid; // 32 hexadecimal digits
    std::string apiVersion;
    std::string unsuitable; // why it cannot be used; empty if it can
    uint64_t largestHeap;   // bytes
    uint64_t largestAllocation, largestStorageBuffer;
    uint32_t largestLayerCount, sharedMemory, subgroupSize;
    uint32_t largestTexelBuffer;    // texels
    bool outputsLayers;             // a vertex shader can choose the layer to draw to (shaderOutputLayer)
    bool subgroupBallot;            // compute shaders support ballots
    bool subgroupSizeCanBeAskedFor; // a compute pipeline can require a subgroup size

    // Returns whether subgroups suit the standard shaders: 8 to 64 invocations, a multiple of 8, with
    // ballots.
    bool hasBallots() const { return subgroupBallot && subgroupSize % 8 == 0 && subgroupSize <= 64; }
    // Returns whether programs are made of portable shaders, which need neither such subgroups nor large
    // texel buffers: they read storage buffers instead.
    bool takesPortableShaders() const;
};

// Returns all Vulkan devices of this machine, in the loader's order; none without a driver.
std::vector<DeviceInfo> listDevices();

struct DeviceOptions {
    // The device's index, UUID or part of its name. Empty: the first discrete GPU, else integrated, else any.
    std::string select;
    // Comma-separated checks of Khronos' validation layer: core, sync, gpu, best. Empty: no validation.
    std::string validation;
    // The instance extensions that the window system needs for its surfaces, so that the device can show
    // images on them. Empty: it draws offscreen only.
    std::vector<std::string> surfaceExtensions;
    // The file that savePipelineCache() writes and that is read at the start. Empty: none.
    std::filesystem::path pipelineCache;
    // Pretends that the device has no output of layers, no ballots, and texel buffers of the least size that
    // Vulkan permits, to test the paths for such devices on any device.
    bool leastFeatures = false;
};

// A device of a host program, which must keep it alive while anything of Relume's refers to it.
struct HostDevice {
    VkInstance instance = VK_NULL_HANDLE; // of Vulkan 1.3
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    // The options that the device was made with. Only the constructor reads them, to check the features.
    const VkDeviceCreateInfo* created = nullptr;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queueFamily = 0; // the queue's; must do graphics and compute
};

// A chain of feature structs for a host program that makes its own device. docs/engine.md lists the features
// that are required, all of which listDevices() demands of a suitable device, and the two that are used where
// enabled. No extension is needed.
struct Features {
    Features();
    Features(const Features&) = delete; // it points into itself
    Features& operator=(const Features&) = delete;

    // The head of the chain, for VkDeviceCreateInfo::pNext, with pEnabledFeatures null; the others follow.
    VkPhysicalDeviceFeatures2 chain;
    VkPhysicalDeviceVulkan12Features vulkan12;
    VkPhysicalDeviceVulkan13Features vulkan13;
};
// Turns on the required features, and the optional ones that `physical` supports.
void enableFeatures(VkPhysicalDevice physical, Features& features);

// Owns instance, device and queue, or uses those of a host program. Most other objects keep a reference to
// it, so that it must outlive them and cannot be moved.
class Device {
  public:
    // Throws NoDeviceError if no device is suitable, UsageError if options cannot be understood, and Error if
    // the validation layer is not installed.
    explicit Device(const DeviceOptions& options = {});
    // Uses the host's device. Only functions whose comments say that they wait submit to its queue, to upload
    // and to read back. Throws NoDeviceError, naming what is missing, if the device is unsuitable, and
    // UsageError if `host` is incomplete or its queue family cannot do both graphics and compute.
    explicit Device(const HostDevice& host);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkInstance instance() const { return mInstance; }
    VkDevice handle() const { return mDevice; }
    VkPhysicalDevice physical() const { return mPhysical; }
    VkQueue queue() const { return mQueue; }
    // Locks the queue, which threads may share. Hold the lock while using queue().
    std::unique_lock<std::mutex> lockQueue() const { return std::unique_lock(mQueueMutex); }
    uint32_t queueFamily() const { return mQueueFamily; }
    const VkPhysicalDeviceLimits& limits() const { return mProperties.limits; }
    const std::string& name() const { return mInfo.name; }
    const DeviceInfo& info() const { return mInfo; }

    // Returns the size in bytes of the largest buffer that one binding may cover and one allocation may hold.
    uint64_t largestStorageBuffer() const { return mInfo.largestStorageBuffer; }
    // Returns the largest number of texels, of `texelBytes` each, of a Binding::texelsOf().
    uint64_t mostTexels(uint64_t texelBytes) const {
        return mInfo.takesPortableShaders() ? largestStorageBuffer() / texelBytes : mInfo.largestTexelBuffer;
    }

    // Returns the number of valid bits of a timestamp, 36 to 64, or 0 if the queue has no timestamps.
    uint32_t timestampBits() const { return mTimestampBits; }
    // Returns the function that reads the device's clock and CLOCK_MONOTONIC together; null if unsupported.
    PFN_vkGetCalibratedTimestampsEXT readClocks() const { return mReadClocks; }

    MemoryPool& memory() const { return *mMemoryPool; }

    // Returns the index of a memory type among `typeBits` that has `properties`, and `preferred` too if
    // possible. Throws Error if there is none.
    uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags properties,
                        VkMemoryPropertyFlags preferred = 0) const;

    // Names an object in captures and validation messages. Does nothing without debug utilities.
    void setName(VkObjectType type, uint64_t handle, std::string_view name) const;
    void beginLabel(VkCommandBuffer commands, const char* name) const;
    void endLabel(VkCommandBuffer commands) const;

    // Returns the programs that were made so far.
    Programs& programs() const { return *mPrograms; }

    // Returns the cache that every pipeline is created with; any thread may use it.
    VkPipelineCache pipelineCache() const;
    // Writes DeviceOptions::pipelineCache atomically; logs a warning if it cannot be written.
    void savePipelineCache() const;

    // Returns the portable version of `builtIn`, an array of a generated shaders/*.h, if this device takes
    // those; else `builtIn` itself.
    std::span<const uint32_t> fitting(std::span<const uint32_t> builtIn) const;
    // Returns the SPIR-V from which programs are made for `builtIn`: its replacement if it has one, else the
    // fitting one.
    std::vector<uint32_t> shader(std::span<const uint32_t> builtIn) const;
    // Replaces shaders in all programs that are made from now on, by any thread. Throws Error, and replaces
    // none, if one cannot take the place of the shader it replaces. Returns the number of
    // shaders that differ from those in use before.
    size_t replaceShaders(std::span<const ShaderReplacement> replacements);

    // Returns the number of warnings and errors that the validation layer has reported; 0 without validation.
    int validationMessages() const { return mValidationMessages; }

  private:
    friend VkBool32 onValidationMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                        VkDebugUtilsMessageTypeFlagsEXT,
                                        const VkDebugUtilsMessengerCallbackDataEXT*, void*);
    void createInstance(const DeviceOptions& options);
    void loadDebugUtils();
    void pickPhysicalDevice(const std::string& select, bool leastFeatures);
    void setPhysicalDevice(VkPhysicalDevice physical, uint32_t queueFamily);
    void createDevice(bool showsImages);
    void destroy();

    bool mIsHosts = false; // whether a host program owns instance and device
    VkInstance mInstance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT mMessenger = VK_NULL_HANDLE;
    VkPhysicalDevice mPhysical = VK_NULL_HANDLE;
    VkDevice mDevice = VK_NULL_HANDLE;
    VkQueue mQueue = VK_NULL_HANDLE;
    mutable std::mutex mQueueMutex;
    uint32_t mQueueFamily = 0;
    uint32_t mTimestampBits = 0;
    VkPhysicalDeviceProperties mProperties{};
    VkPhysicalDeviceMemoryProperties mMemory{};
    DeviceInfo mInfo{};
    std::unique_ptr<MemoryPool> mMemoryPool;
    std::unique_ptr<PipelineCache> mPipelineCache;
    std::unique_ptr<Programs> mPrograms;
    mutable std::mutex mShaderMutex;
    std::map<const uint32_t*, std::vector<uint32_t>> mReplacedShaders; // by the built-in array
    std::atomic<int> mValidationMessages = 0;
    PFN_vkSetDebugUtilsObjectNameEXT mSetName = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT mBeginLabel = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT mEndLabel = nullptr;
    PFN_vkGetCalibratedTimestampsEXT mReadClocks = nullptr;
};

} // namespace relume::vk
