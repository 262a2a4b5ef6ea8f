// Tests readers when memory runs out, at every allocation.
#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/image_codecs.h"
#include "engine/import/mesh_file.h"
#include "engine/import/texture_file.h"
#include "engine/transport/kept_visibility.h"
#include "tests/support/checkpoint_sample.h"
#include "tests/support/kept_sample.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/texture_samples.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <doctest/doctest.h>
#include <functional>
#include <new>

namespace {

constexpr long kNever = -1;
constexpr size_t kUsual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;
thread_local long allocationsLeft = kNever; // of this thread before one fails
thread_local bool hasFailed = false;
std::atomic<long> blocksHeld = 0; // of memory that are held

void* allocate(size_t size, size_t alignment) {
    if (allocationsLeft != kNever && allocationsLeft-- == 0) {
        hasFailed = true;
        throw std::bad_alloc();
    }
    const size_t rounded = std::max(alignment, (size + alignment - 1) / alignment * alignment);
    void* const block = alignment <= kUsual ? std::malloc(rounded) : std::aligned_alloc(alignment, rounded);
    if (!block) throw std::bad_alloc();
    blocksHeld++;
    return block;
}

void* tryToAllocate(size_t size) noexcept {
    try {
        return allocate(size, kUsual);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

void release(void* block) {
    if (block) blocksHeld--;
    std::free(block);
}

} // namespace

// All of them, so that none is a sanitizer's own.
void* operator new(size_t size) { return allocate(size, kUsual); }
void* operator new[](size_t size) { return allocate(size, kUsual); }
void* operator new(size_t size, std::align_val_t alignment) { return allocate(size, size_t(alignment)); }
void* operator new[](size_t size, std::align_val_t alignment) { return allocate(size, size_t(alignment)); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return tryToAllocate(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return tryToAllocate(size); }
void operator delete(void* block) noexcept { release(block); }
void operator delete[](void* block) noexcept { release(block); }
void operator delete(void* block, size_t) noexcept { release(block); }
void operator delete[](void* block, size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, size_t, std::align_val_t) noexcept { release(block); }
void operator delete[](void* block, size_t, std::align_val_t) noexcept { release(block); }

using namespace relume;
using namespace relume::test;

namespace {

struct Reading {
    const char* name;
    std::function<void()> read;
    bool isLeaky = false; // the library itself loses memory
};

std::span<const std::byte> bytesOf(const std::string& text) { return std::as_bytes(std::span(text)); }

// Readers that use no JSON, whose library allocates while it frees: there the program ends.
std::vector<Reading> readings() {
    static const Bytes asset = encodeAsset(mixedAsset()), kept = fileOf(keptChunks());
    static const std::string obj = sampleObj(makeSphere(0)),
                             ply = samplePly(makeSphere(0), PlySample::LittleEndian);
    static const Texture texture{2, 3, {1, 2, 3, 4, 5, 0xff000000}, true};
    static const std::string png = samplePng(texture), jpeg = sampleJpeg(texture);
    static const Image image = [] {
        Image ones(4, 3);
        ones.pixels.assign(12, vec4(1));
        return ones;
    }();
    static const Bytes exr = encodeExr(image);
    static const std::string radiance =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string(8, '\x42');
    static const CheckpointSample checkpoint(TransportLayout::Bases);
    return {{"asset", [] { decodeAsset(asset, "a"); }},
            {"kept visibility",
             [] {
                 KeptVisibility visibility(sourceOf(kept), "a");
                 visibility.verify(visibility.skeleton());
             }},
            {"checkpoint", [] { checkpoint.resumed(checkpoint.file()); }},
            {"OBJ",
             [] {
                 decodeMesh(bytesOf(obj), "a.obj", UpAxis::Y, {true, true});
             }},
            {"PLY",
             [] {
                 decodeMesh(bytesOf(ply), "a.ply", UpAxis::Y, {true, true});
             }},
            {"PNG", [] { decodeTexture(bytesOf(png), "a.png", true); }},
            {"PNG, written",
             [] {
                 encodePng(2, 3, std::span(reinterpret_cast<const uint8_t*>(texture.texels.data()), 24),
                           "a.png");
             }},
            {"JPEG", [] { decodeTexture(bytesOf(jpeg), "a.jpg", true); }},
            {"OpenEXR", [] { decodeImage(exr, "a.exr"); }, true},
            {"OpenEXR, written", [] { encodeExr(image); }, true},
            {"Radiance", [] { decodeImage(bytesOf(radiance), "a.hdr"); }}};
}

// Reads until nothing fails; gives how many allocations failed before, one in each reading.
size_t failEach(const Reading& reading) {
    reading.read(); // what is made once is not the reader's to free
    for (long count = 0;; count++) {
        const long before = blocksHeld;
        hasFailed = false;
        bool isSaid = false;
        allocationsLeft = count;
        try {
            reading.read();
        } catch (const std::bad_alloc&) {
            isSaid = true;
        } catch (const Error&) { // which would tell of something else
        }
        allocationsLeft = kNever;
        const long after = blocksHeld;
        CAPTURE(count);
        if (!hasFailed) return size_t(count);
        CHECK(isSaid);
        if (!reading.isLeaky) REQUIRE_EQ(after, before);
    }
}

} // namespace

TEST_CASE("out of memory: whichever allocation of a reader fails, it says so and keeps nothing") {
    size_t failures = 0;
    for (const Reading& reading : readings()) {
        CAPTURE(std::string(reading.name));
        failures += failEach(reading);
    }
    CHECK(failures > 1000);
}
