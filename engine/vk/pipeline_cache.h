// What the driver has compiled, kept in a file from one start to the next.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace relume::vk {

// The bytes of a file that keeps `data` for this driver.
std::vector<std::byte> packPipelineCache(const VkPhysicalDeviceProperties& driver,
                                         std::span<const std::byte> data);

// What packPipelineCache() packed into `file`. Empty unless that is whole, undamaged and of this very driver:
// drivers need not check what they are given.
std::span<const std::byte> unpackPipelineCache(const VkPhysicalDeviceProperties& driver,
                                               std::span<const std::byte> file);

// Owns a VkPipelineCache.
class PipelineCache {
  public:
    // Begins with what the file at `path` keeps, or empty where it keeps nothing of use. `path` may be empty.
    PipelineCache(VkDevice device, const VkPhysicalDeviceProperties& driver, std::filesystem::path path);
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return mCache; }

    // Writes the file, whole or not at all, and its folder; warns where it cannot be written. Does nothing
    // without a path.
    void save() const;

  private:
    std::vector<std::byte> data() const;

    VkDevice mDevice;
    VkPhysicalDeviceProperties mDriver;
    std::filesystem::path mPath;
    VkPipelineCache mCache = VK_NULL_HANDLE;
};

} // namespace relume::vk
