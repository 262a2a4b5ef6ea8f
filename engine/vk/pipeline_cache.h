// The driver's pipeline cache, kept in a file between runs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace relume::vk {

// Returns the contents of a cache file that holds `data` for this driver.
std::vector<std::byte> packPipelineCache(const VkPhysicalDeviceProperties& driver,
                                         std::span<const std::byte> data);

// Returns the data that packPipelineCache() put into `file`; empty unless the file is undamaged and of
// exactly this driver, since drivers need not check what they are given.
std::span<const std::byte> unpackPipelineCache(const VkPhysicalDeviceProperties& driver,
                                               std::span<const std::byte> file);

// A VkPipelineCache and the file that it is kept in.
class PipelineCache {
  public:
    // Starts with the contents of the file at `path`, or empty if they are of no use. `path` may be empty.
    PipelineCache(VkDevice device, const VkPhysicalDeviceProperties& driver, std::filesystem::path path);
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return mCache; }

    // Writes the file atomically, making its folder; logs a warning if it cannot be written. Does nothing
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
