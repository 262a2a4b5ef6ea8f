// Tests that relights, loads and swaps, repeated, take no more memory, open no more files, and end with the
// bits that they began with. RELUME_SOAK=1 (scripts/soak) repeats them as often as a long use does.
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/render/view_pass.h"
#include "precompute/bake/bake.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <malloc.h>
#include <optional>
#include <string>
#include <thread>
#include <vector>

using namespace relume;
using namespace relume::test;

namespace {

// Validation keeps some megabytes for every pipeline that ever was (layer 1.3.239).
const vk::DeviceOptions kUnchecked{.validation = ""};

int repeats(int usual, int soak) { return std::getenv("RELUME_SOAK") ? soak : usual; }

// The memory and files that this process holds. A software device's memory is part of the heap.
struct Held {
    size_t heapBytes;
    size_t deviceAllocations;
    size_t files; // open
};

Held heldNow(const vk::Device& device) {
    malloc_trim(0);
    const struct mallinfo2 heap = mallinfo2();
    const auto files = std::filesystem::directory_iterator("/proc/self/fd");
    return {heap.uordblks + heap.hblkhd, device.memory().allocations(),
            size_t(std::distance(begin(files), end(files)))};
}

// Returns the least that is held until nothing has been freed for 0.3 seconds: drivers store shaders and free
// what is no longer used in threads of their own.
Held heldAtRest(const vk::Device& device) {
    using namespace std::chrono_literals;
    Held least = heldNow(device);
    for (int sinceLeast = 0; sinceLeast < 6; sinceLeast++) {
        std::this_thread::sleep_for(50ms);
        const Held held = heldNow(device);
        if (held.heapBytes < least.heapBytes) least = held, sinceLeast = 0;
    }
    return least;
}

// Calls step(i) `count` times, an even number of at least 10, and finds that the second half of these leaves
// no more than the first did. Compares the least after the last steps with the most before the middle:
// lavapipe may or may not hold 64 MB of what was drawn last, depending on when its threads run.
template <typename Step>
void checkFlat(const char* what, const vk::Device& device, int count, const Step& step) {
    constexpr int kEarly = 5, kLate = 3; // steps after which is looked
    std::vector<Held> early, late;
    for (int i = 0; i < count; i++) {
        step(i);
        if (i < count / 2 && i >= count / 2 - kEarly) early.push_back(heldAtRest(device));
        if (i >= count - kLate) late.push_back(heldAtRest(device));
    }
    Held before{}, after = late[0];
    for (const Held& held : early)
        before = {std::max(before.heapBytes, held.heapBytes),
                  std::max(before.deviceAllocations, held.deviceAllocations),
                  std::max(before.files, held.files)};
    for (const Held& held : late)
        after = {std::min(after.heapBytes, held.heapBytes),
                 std::min(after.deviceAllocations, held.deviceAllocations),
                 std::min(after.files, held.files)};
    const double growth = double(after.heapBytes) / double(before.heapBytes) - 1;
    MESSAGE(std::string(what), ": ", count, " times; heap ", before.heapBytes, " bytes, then ", 100 * growth,
            " % more; ", before.deviceAllocations, " allocations of the device, ", before.files,
            " open files");
#ifndef RELUME_SANITIZE // sanitizers have a heap of their own
    CHECK_LE(growth, 0.01);
#endif
    CHECK_LE(after.deviceAllocations, before.deviceAllocations);
    CHECK_LE(after.files, before.files);
}

// A ball in one of two materials of a set, over a plane.
Scene twoParts() {
    Scene scene;
    Mesh plane = makePlane(8, 3);
    for (vec3& position : plane.positions) position.y -= 1;
    scene.parts.push_back({"ball", makeSphere(3), R"({"set": ["gold", "red-plastic"]})", "", ""});
    scene.parts.push_back({"plane", std::move(plane), "white-diffuse", "", ""});
    return scene;
}

Asset bakeTwoParts(const vk::Device& device) {
    BakeOptions options;
    options.factorization.terms = 3;
    options.visibilitySize = 64;
    options.coefficients = 96;
    options.mapSize = 24;
    return bake(device, twoParts(), options);
}

constexpr int kDriftWidth = 96, kDriftHeight = 72;
const Camera kCamera{{0, 1.5f, 4}, {0, 0, 0}, 0.8f};

// Draws an asset as a program does that changes light, look and size.
class Drawing {
  public:
    Drawing(const vk::Device& device, const Asset& asset)
        : mAsset(asset), mLight(device, asset.faceSize), mRelighter(device, asset),
          mView(device, asset, {.width = kDriftWidth, .height = kDriftHeight}),
          mCommands(device, "drift test"), mAppearance(defaultAppearance(asset)) {}

    // A lamp that turns about the scene and is back after a hundred steps.
    void setLight(int step) {
        const float angle = 0.0628318f * float(step % 100);
        mLight.setLight({.lamps = {{glm::normalize(vec3(std::cos(angle), 1, std::sin(angle))), 0.2f, vec3(9)},
                                   {vec3(0, 1, 0), 0.5f, vec3(1)}}});
    }
    void bind(const std::string& material) {
        bindMaterials(mAppearance, mAsset, std::vector<WeightedMaterial>{{material}});
        mView.setAppearance(mAppearance);
    }
    ViewPass& view() { return mView; }

    void relight() {
        mCommands.begin();
        mLight.record(mCommands);
        mRelighter.record(mCommands, mLight, mAppearance);
        mCommands.submitAndWait();
    }
    std::vector<vec3> tuples() const { return mRelighter.readTuples(0); }
    Image draw() {
        relight();
        return mView.render(kCamera, mRelighter);
    }

  private:
    const Asset& mAsset;
    LightPass mLight;
    Relighter mRelighter;
    ViewPass mView;
    vk::Commands mCommands;
    Appearance mAppearance;
};

} // namespace

TEST_CASE("drift: light that changes takes no memory, and comes back to its bits") {
    const vk::Device device(kUnchecked);
    const Asset asset = bakeTwoParts(device);
    Drawing drawing(device, asset);
    drawing.setLight(0);
    drawing.relight();
    const std::vector<vec3> first = drawing.tuples();
    const int count = repeats(300, 10'000);
    checkFlat("relights", device, count, [&](int i) {
        drawing.setLight(count - 1 - i); // ends with the first
        drawing.relight();
    });
    CHECK(drawing.tuples() == first);
}

TEST_CASE("drift: bakes are loaded, drawn and dropped without a trace") {
    const vk::Device device(kUnchecked);
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "drift.relume";
    writeAsset(path, bakeTwoParts(device));
    std::optional<Image> first;
    checkFlat("loads", device, repeats(10, 1'000), [&](int) {
        const Asset asset = readAsset(path);
        Drawing drawing(device, asset);
        drawing.setLight(7);
        const Image image = drawing.draw();
        if (!first) first = image;
        CHECK(image.pixels == first->pixels);
    });
}

TEST_CASE("drift: swaps of materials and sizes of images leave nothing behind") {
    const vk::Device device(kUnchecked);
    const Asset asset = bakeTwoParts(device);
    Drawing drawing(device, asset);
    drawing.setLight(7);
    const Image first = drawing.draw();
    checkFlat("swaps and resizes", device, repeats(20, 1'000), [&](int i) {
        drawing.bind(i % 2 == 0 ? "red-plastic" : "gold");
        drawing.view().setSamples(i % 3 == 0 ? 1 : 4);
        drawing.view().resize(kDriftWidth + i % 7 * 16, kDriftHeight + i % 5 * 8);
        drawing.draw();
    });
    drawing.bind("gold");
    drawing.view().setSamples(ViewOptions{}.samples);
    drawing.view().resize(kDriftWidth, kDriftHeight);
    CHECK(drawing.draw().pixels == first.pixels);
}
