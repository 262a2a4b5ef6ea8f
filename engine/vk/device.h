// A Vulkan 1.3 device with one queue for everything.
#pragma once

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

class PipelineCache;
struct ShaderReplacement;

// What `relume devices` shows of a device.
struct DeviceInfo {
    uint32_t index;
    std::string name;
    bool isSoftware;
    std::string type; // "discrete GPU", "integrated GPU", "software", …
    std::string driver;
    std::string uuid; // 32 hexadecimal digits
    std::string apiVersion;
    std::string unsuitable; // Why it cannot be used; empty if it can
    uint64_t largestHeap;   // bytes
    uint64_t largestAllocation, largestStorageBuffer;
    uint32_t largestLayerCount, sharedMemory, subgroupSize;
    uint32_t largestTexelBuffer;    // texels
    bool outputsLayers;             // vertex shaders choose the layer that is drawn into
    bool subgroupBallot;            // in compute shaders
    bool subgroupSizeCanBeAskedFor; // by a compute program

    // Subgroups that standard shaders can work with: of 8 to 64 invocations, that vote.
    bool hasBallots() const { return subgroupBallot && subgroupSize % 8 == 0 && subgroupSize <= 64; }
    // Programs are made of shaders that need no such subgroups, and read storage buffers instead of texel
    // buffers.
    bool takesPortableShaders() const;
};

// All Vulkan devices of this machine, in the loader's order. Empty when there is no driver.
std::vector<DeviceInfo> listDevices();

struct DeviceOptions {
    // Index, UUID or part of a name; empty: the first discrete GPU, else integrated, else any.
    std::string select;
    // Comma-separated checks of Khronos' validation layer: core, sync, gpu, best. Empty: none.
    std::string validation;
    // What the window system's surfaces need of the instance; the device can then show images on them.
    // Empty: it draws into images of its own alone.
    std::vector<std::string> surfaceExtensions;
    // The file that keeps what the driver compiles, for savePipelineCache(). Empty: none does.
    std::filesystem::path pipelineCache;
    // As if the device had no output of layers, no ballots, and texel buffers as small as Vulkan allows: to
    // test on one that has more what is done on those that do not.
    bool leastFeatures = false;
};

// A device of a host program, which made it and keeps it for as long as anything of ours refers to it.
struct HostDevice {
    VkInstance instance = VK_NULL_HANDLE; // of Vulkan 1.3
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    // The device was made with this; only the constructor looks at it, to check the features.
    const VkDeviceCreateInfo* created = nullptr;
    VkQueue queue = VK_NULL_HANDLE;
    uint32_t queueFamily = 0; // of the queue; it must do graphics and compute
};

// A chain of features for a host that makes its own device. docs/engine.md lists those that are needed, which
// every device has that listDevices() calls suitable, and two that are used where they are on. No extension
// is needed.
struct Features {
    Features();
    Features(const Features&) = delete; // it points into itself
    Features& operator=(const Features&) = delete;

    // For VkDeviceCreateInfo::pNext, with no pEnabledFeatures beside it; the other two follow it.
    VkPhysicalDeviceFeatures2 chain;
    VkPhysicalDeviceVulkan12Features vulkan12;
    VkPhysicalDeviceVulkan13Features vulkan13;
};
// Turns on what is needed, and what is used where `physical` offers it.
void enableFeatures(VkPhysicalDevice physical, Features& features);

// Owns instance, device and queue, or uses those of a host program. Everything refers to it: it stays where
// it is.
class Device {
  public:
    // Throws NoDeviceError when nothing suits, UsageError when options cannot be understood.
    explicit Device(const DeviceOptions& options = {});
    // Works on the host's device. Only functions whose comments say that they wait for the device use its
    // queue, to upload and to read back. Throws NoDeviceError that names the missing feature, and UsageError
    // where `host` is incomplete or its queue family cannot do both graphics and compute.
    explicit Device(const HostDevice& host);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkInstance instance() const { return mInstance; }
    VkDevice handle() const { return mDevice; }
    VkPhysicalDevice physical() const { return mPhysical; }
    VkQueue queue() const { return mQueue; }
    // To be held while something is given to the queue: threads may share it.
    std::unique_lock<std::mutex> lockQueue() const { return std::unique_lock(mQueueMutex); }
    uint32_t queueFamily() const { return mQueueFamily; }
    const VkPhysicalDeviceLimits& limits() const { return mProperties.limits; }
    const std::string& name() const { return mInfo.name; }
    const DeviceInfo& info() const { return mInfo; }

    // Bytes of the largest buffer that one binding may see, and that one allocation may hold.
    uint64_t largestStorageBuffer() const { return mInfo.largestStorageBuffer; }
    // The most texels, of so many bytes, of a Binding::texelsOf().
    uint64_t mostTexels(uint64_t texelBytes) const {
        return mInfo.takesPortableShaders() ? largestStorageBuffer() / texelBytes : mInfo.largestTexelBuffer;
    }

    // Bits of a timestamp that count, 36 to 64; 0: the queue writes none.
    uint32_t timestampBits() const { return mTimestampBits; }
    // Reads the clocks of the device and of the CPU (CLOCK_MONOTONIC) together; null where it is not offered.
    PFN_vkGetCalibratedTimestampsEXT readClocks() const { return mReadClocks; }

    // Index of a memory type with these properties among `typeBits`, with `preferred` ones too if it can be;
    // throws Error if there is none.
    uint32_t memoryType(uint32_t typeBits, VkMemoryPropertyFlags properties,
                        VkMemoryPropertyFlags preferred = 0) const;

    // Gives an object its name in captures and validation messages; does nothing without debug utilities.
    void setName(VkObjectType type, uint64_t handle, std::string_view name) const;
    void beginLabel(VkCommandBuffer commands, const char* name) const;
    void endLabel(VkCommandBuffer commands) const;

    // What every pipeline is made with; any thread may use it.
    VkPipelineCache pipelineCache() const;
    // Writes DeviceOptions::pipelineCache, whole or not at all; warns where it cannot be written.
    void savePipelineCache() const;

    // What programs are made of where `builtIn`, an array of shaders/*.h, is given: its replacement if it has
    // one, else what this device takes for it, mostly itself.
    std::vector<uint32_t> shader(std::span<const uint32_t> builtIn) const;
    // Replaces shaders in the programs that are made from now on, by any thread. Throws Error, and replaces
    // none, when one has another interface than what it replaces. Returns how many differ from what was in
    // use.
    size_t replaceShaders(std::span<const ShaderReplacement> replacements);

    // Warnings and errors that the validation layer has reported; 0 without validation.
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
    std::span<const uint32_t> fitting(std::span<const uint32_t> builtIn) const;
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
    std::unique_ptr<PipelineCache> mPipelineCache;
    mutable std::mutex mShaderMutex;
    std::map<const uint32_t*, std::vector<uint32_t>> mReplacedShaders; // by the built-in array
    std::atomic<int> mValidationMessages = 0;
    PFN_vkSetDebugUtilsObjectNameEXT mSetName = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT mBeginLabel = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT mEndLabel = nullptr;
    PFN_vkGetCalibratedTimestampsEXT mReadClocks = nullptr;
};

} // namespace relume::vk
