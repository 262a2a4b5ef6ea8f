#include "engine/vk/memory.h"

#include "engine/base/check.h"
#include "engine/vk/result.h"

#include <algorithm>
#include <optional>

namespace relume::vk {

struct MemoryPool::Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint64_t bytes = 0;
    uint32_t type = 0;
    MemoryKind kind = MemoryKind::Buffer;
    bool isShared = false;
    std::byte* mapped = nullptr;
    std::map<uint64_t, uint64_t> gaps; // size by offset; neighbors are merged

    // Takes the first gap that fits and returns its offset.
    std::optional<uint64_t> take(uint64_t size, uint64_t alignment) {
        for (const auto& gap : gaps) {
            const auto [offset, length] = gap; // a copy, since the gap is erased
            const uint64_t start = (offset + alignment - 1) / alignment * alignment;
            if (start + size > offset + length) continue;
            gaps.erase(offset);
            if (start > offset) gaps[offset] = start - offset;
            if (start + size < offset + length) gaps[start + size] = offset + length - start - size;
            return start;
        }
        return std::nullopt;
    }

    void giveBack(uint64_t offset, uint64_t size) {
        auto next = gaps.lower_bound(offset);
        if (next != gaps.end() && next->first == offset + size) {
            size += next->second;
            next = gaps.erase(next);
        }
        if (next != gaps.begin()) {
            const auto before = std::prev(next);
            if (before->first + before->second == offset) {
                before->second += size;
                return;
            }
        }
        gaps[offset] = size;
    }

    bool isEmpty() const { return gaps.size() == 1 && gaps.begin()->second == bytes; }
};

MemoryPool::MemoryPool(VkDevice device) : mDevice(device) {}

MemoryPool::~MemoryPool() {
    for (const auto& block : mBlocks) vkFreeMemory(mDevice, block->memory, nullptr);
}

MemoryPool::Range::~Range() {
    if (mBlock) mPool->free(*this);
}

MemoryPool::Range& MemoryPool::Range::operator=(Range&& other) noexcept {
    std::swap(mPool, other.mPool);
    std::swap(mBlock, other.mBlock);
    std::swap(mOffset, other.mOffset);
    std::swap(mBytes, other.mBytes);
    return *this;
}

VkDeviceMemory MemoryPool::Range::memory() const { return mBlock->memory; }

void* MemoryPool::Range::mapped() const { return mBlock->mapped ? mBlock->mapped + mOffset : nullptr; }

MemoryPool::Range MemoryPool::allocate(const VkMemoryRequirements& requirements, uint32_t type,
                                       MemoryKind kind) {
    const std::scoped_lock lock(mMutex);
    Range range;
    range.mPool = this;
    range.mBytes = requirements.size;
#ifdef RELUME_SANITIZE
    const bool isShared = false; // so that a sanitizer detects accesses beyond the end of a buffer
#else
    const bool isShared = requirements.size <= kLargestShared;
#endif
    if (isShared)
        for (const auto& block : mBlocks) {
            if (!block->isShared || block->type != type || block->kind != kind) continue;
            const auto offset = block->take(requirements.size, requirements.alignment);
            if (!offset) continue;
            range.mBlock = block.get();
            range.mOffset = *offset;
            return range;
        }
    Block& block = makeBlock(isShared ? kBlockBytes : requirements.size, type, kind);
    block.isShared = isShared;
    range.mOffset = block.take(requirements.size, requirements.alignment).value();
    range.mBlock = &block;
    return range;
}

MemoryPool::Block& MemoryPool::makeBlock(uint64_t bytes, uint32_t type, MemoryKind kind) {
    auto block = std::make_unique<Block>();
    block->bytes = bytes;
    block->type = type;
    block->kind = kind;
    block->gaps[0] = bytes;
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = bytes;
    allocate.memoryTypeIndex = type;
    mBlocks.reserve(mBlocks.size() + 1); // nothing may throw between allocation and ownership
    block->memory = RELUME_VK_CREATE(vkAllocateMemory, mDevice, allocate);
    mBlocks.push_back(std::move(block));
    if (kind == MemoryKind::MappedBuffer) {
        void* mapped = nullptr;
        const VkResult result = vkMapMemory(mDevice, mBlocks.back()->memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result != VK_SUCCESS) {
            vkFreeMemory(mDevice, mBlocks.back()->memory, nullptr);
            mBlocks.pop_back();
            check(result, "vkMapMemory");
        }
        mBlocks.back()->mapped = static_cast<std::byte*>(mapped);
    }
    return *mBlocks.back();
}

void MemoryPool::free(const Range& range) {
    const std::scoped_lock lock(mMutex);
    range.mBlock->giveBack(range.mOffset, range.mBytes);
    if (!range.mBlock->isEmpty()) return;
    // Keep one empty block of a kind, so that a buffer which comes and goes does not allocate each time.
    const auto isSpare = [&](const auto& block) {
        return block.get() != range.mBlock && block->isShared && block->isEmpty() &&
               block->type == range.mBlock->type && block->kind == range.mBlock->kind;
    };
    if (range.mBlock->isShared && std::ranges::none_of(mBlocks, isSpare)) return;
    vkFreeMemory(mDevice, range.mBlock->memory, nullptr);
    std::erase_if(mBlocks, [&](const auto& block) { return block.get() == range.mBlock; });
}

size_t MemoryPool::allocations() const {
    const std::scoped_lock lock(mMutex);
    return mBlocks.size();
}

} // namespace relume::vk
