// Device memory. Small buffers and images share blocks, because devices allow as few as 4,096 allocations.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>
#include <vulkan/vulkan.h>

namespace relume::vk {

// The use of memory. Each kind has blocks of its own, because some devices need gaps between buffers and
// images.
enum class MemoryKind { Buffer, MappedBuffer, Image };

// Allocates ranges of device memory. Thread-safe.
class MemoryPool {
  public:
    // Ranges of at most this many bytes share blocks; larger ones have an allocation of their own.
    static constexpr uint64_t kLargestShared = uint64_t(1) << 20;
    static constexpr uint64_t kBlockBytes = uint64_t(16) << 20;

    explicit MemoryPool(VkDevice device);
    ~MemoryPool();
    MemoryPool(const MemoryPool&) = delete;
    MemoryPool& operator=(const MemoryPool&) = delete;

    struct Block;
    // A range, given back when it is destroyed. Keeps a reference to the pool.
    class Range {
      public:
        Range() = default;
        ~Range();
        Range(Range&& other) noexcept { *this = std::move(other); }
        Range& operator=(Range&& other) noexcept;

        explicit operator bool() const { return mBlock != nullptr; }
        VkDeviceMemory memory() const;
        uint64_t offset() const { return mOffset; }
        // Returns the range on the host, or null if the memory is not mapped.
        void* mapped() const;

      private:
        friend MemoryPool;
        MemoryPool* mPool = nullptr;
        Block* mBlock = nullptr;
        uint64_t mOffset = 0, mBytes = 0;
    };

    // Returns a range that fits the requirements, of memory type `type`. Throws OutOfMemory.
    Range allocate(const VkMemoryRequirements& requirements, uint32_t type, MemoryKind kind);

    // Returns the number of Vulkan allocations that are alive.
    size_t allocations() const;

  private:
    Block& makeBlock(uint64_t bytes, uint32_t type, MemoryKind kind);
    void free(const Range& range);

    VkDevice mDevice;
    mutable std::mutex mMutex;
    std::vector<std::unique_ptr<Block>> mBlocks;
};

} // namespace relume::vk
