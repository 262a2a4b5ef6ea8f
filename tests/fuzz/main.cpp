// The program of libFuzzer's: runs the target that RELUME_FUZZ_TARGET names, and aborts when an input makes
// it hold more memory than its target allows. With RELUME_FUZZ_SEEDS, the name of a folder, it writes the
// target's seeds there first.
#include "engine/base/file.h"
#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <sanitizer/allocator_interface.h>
#include <string>

using namespace relume;
using namespace relume::test;

namespace {

const FuzzTarget* chosen = nullptr;
std::atomic<int64_t> held = 0, most = 0; // bytes of the heap since the input began

void noteAllocation(const volatile void*, size_t size) {
    const int64_t now = held += int64_t(size);
    for (int64_t before = most; now > before && !most.compare_exchange_weak(before, now);) {
    }
}

void noteRelease(const volatile void* block) {
    if (block) held -= int64_t(__sanitizer_get_allocated_size(const_cast<const void*>(block)));
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    const char* const name = std::getenv("RELUME_FUZZ_TARGET");
    const auto found = std::ranges::find(fuzzTargets(), std::string(name ? name : ""), &FuzzTarget::name);
    if (found == fuzzTargets().end()) {
        std::fputs("RELUME_FUZZ_TARGET: expected one of", stderr);
        for (const FuzzTarget& target : fuzzTargets()) std::fprintf(stderr, " %s", target.name);
        std::fputs("\n", stderr);
        std::exit(2);
    }
    chosen = &*found;
    if (const char* const folder = std::getenv("RELUME_FUZZ_SEEDS")) {
        const std::vector<Bytes> seeds = chosen->seeds();
        for (size_t i = 0; i < seeds.size(); i++)
            writeFileAtomically(std::string(folder) + "/seed-" + std::to_string(i), seeds[i]);
    }
    chosen->run({}); // what is made once is not the input's
    __sanitizer_install_malloc_and_free_hooks(noteAllocation, noteRelease);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    held = most = 0;
    chosen->run(std::as_bytes(std::span(data, size)));
    const uint64_t allowed = chosen->mostBytes + chosen->mostBytesPerByte * size;
    if (uint64_t(most.load()) > allowed) {
        std::fprintf(stderr, "%s: held %lld bytes for an input of %zu, which may take %llu\n", chosen->name,
                     static_cast<long long>(most.load()), size, static_cast<unsigned long long>(allowed));
        std::abort();
    }
    return 0;
}
