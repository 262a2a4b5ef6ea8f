// Makes memory run out at a chosen allocation: part of a library for LD_PRELOAD, set by environment
// variables.
// RELUME_FAULT_MEMORY_CALL   its number, from 1, among the allocations by C++'s operators in the program's
//                            own code, not in its libraries'; 0: none. stderr says that it fails, and in the
//                            end how many there were
// RELUME_FAULT_MEMORY_BYTES  counts allocations of at least so many bytes alone
// RELUME_FAULT_MEMORY_PLACES if 1, of allocations that the same stack of calls led to only the first counts,
//                            and a driver's not at all
#include "tests/support/faults.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <execinfo.h>
#include <iterator>
#include <link.h>
#include <new>

using namespace relume::test;

namespace {

std::atomic<long> gAllocations = 0;

// The addresses of the program's code and data.
struct Range {
    uintptr_t first = 0, end = 0;
};

Range programRange() {
    Range range;
    // The program itself is the first that is visited.
    dl_iterate_phdr(
        [](dl_phdr_info* info, size_t, void* target) {
            auto& found = *static_cast<Range*>(target);
            found.first = info->dlpi_addr;
            for (int i = 0; i < info->dlpi_phnum; i++)
                if (info->dlpi_phdr[i].p_type == PT_LOAD)
                    found.end = std::max(found.end, uintptr_t(info->dlpi_addr + info->dlpi_phdr[i].p_vaddr +
                                                              info->dlpi_phdr[i].p_memsz));
            return 1;
        },
        &range);
    return range;
}

// The addresses that the calls which led to an allocation return to, the innermost first; of deep stacks 64.
struct CallStack {
    CallStack() : count(size_t(backtrace(frames, int(std::size(frames))))) {}

    void* frames[64];
    size_t count;
};

// Returns whether a stack is new in this process, for up to 65,536 of them. They are told apart by hashes.
bool isNew(const CallStack& stack) {
    static std::array<std::atomic<uint64_t>, 1 << 16> seen{};
    uint64_t hash = 14695981039346656037u; // FNV-1a
    for (size_t i = 0; i < stack.count; i++)
        hash = (hash ^ reinterpret_cast<uintptr_t>(stack.frames[i])) * 1099511628211u;
    for (size_t place = hash % seen.size();; place = (place + 1) % seen.size()) {
        uint64_t found = 0;
        if (seen[place].compare_exchange_strong(found, hash)) return true;
        if (found == hash) return false;
    }
}

// Returns whether it is a driver that allocates, by a function of the standard library's that the program
// has, too.
bool isByDriver(const CallStack& stack) {
    for (size_t i = 0; i < stack.count; i++) {
        Dl_info info{};
        if (!dladdr(stack.frames[i], &info) || !info.dli_fname) continue;
        for (const char* library : {"/libvulkan", "/libVkLayer", "/libLLVM"})
            if (std::strstr(info.dli_fname, library)) return true;
    }
    return false;
}

// Counts an allocation and returns whether it fails. `caller` is where the operator returns to.
bool fails(size_t bytes, const void* caller) {
    static const Range program = programRange();
    static const bool isCounted = std::getenv("RELUME_FAULT_MEMORY_CALL") != nullptr;
    static const auto least = size_t(number("RELUME_FAULT_MEMORY_BYTES"));
    static const long chosen = number("RELUME_FAULT_MEMORY_CALL");
    const auto address = reinterpret_cast<uintptr_t>(caller);
    if (!isCounted || bytes < least || address < program.first || address >= program.end) return false;
    static const bool countsPlaces = number("RELUME_FAULT_MEMORY_PLACES") != 0;
    if (countsPlaces) {
        const CallStack stack;
        if (!isNew(stack) || isByDriver(stack) || ++gAllocations != chosen) return false;
    } else if (++gAllocations != chosen || isByDriver(CallStack())) {
        return false;
    }
    std::fprintf(stderr, "faults: an allocation of %zu bytes fails\n", bytes);
    return true;
}

void* allocate(size_t bytes, size_t alignment, const void* caller) {
    if (fails(bytes, caller)) return nullptr;
    if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) return std::malloc(std::max<size_t>(bytes, 1));
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

void* require(void* block) {
    if (!block) throw std::bad_alloc();
    return block;
}

constexpr size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

[[gnu::destructor]] void sayAllocations() {
    if (std::getenv("RELUME_FAULT_MEMORY_CALL"))
        std::fprintf(stderr, "faults: %ld allocations\n", long(gAllocations));
}

} // namespace

// All of them, so that none is a sanitizer's own.
#define RELUME_CALLER __builtin_return_address(0)
void* operator new(size_t size) { return require(allocate(size, kUsual, RELUME_CALLER)); }
void* operator new[](size_t size) { return require(allocate(size, kUsual, RELUME_CALLER)); }
void* operator new(size_t size, std::align_val_t alignment) {
    return require(allocate(size, size_t(alignment), RELUME_CALLER));
}
void* operator new[](size_t size, std::align_val_t alignment) {
    return require(allocate(size, size_t(alignment), RELUME_CALLER));
}
void* operator new(size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, kUsual, RELUME_CALLER);
}
void* operator new[](size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, kUsual, RELUME_CALLER);
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, size_t) noexcept { std::free(block); }
void operator delete[](void* block, size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, size_t, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, size_t, std::align_val_t) noexcept { std::free(block); }
