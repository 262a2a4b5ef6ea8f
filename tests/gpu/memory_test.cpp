// Many buffers in few allocations.
#include "engine/vk/commands.h"
#include "engine/vk/upload.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

TEST_CASE(
    "memory: thousands of buffers share few allocations, keep their contents, and give all of it back") {
    const TestDevice validated;
    const vk::Device& device = validated;
    const size_t before = device.memory().allocations();
    std::mt19937 random(1);
    struct Kept {
        vk::Buffer buffer;
        std::vector<uint32_t> values;
    };
    std::vector<Kept> kept;
    const auto add = [&] {
        std::vector<uint32_t> values(1 + random() % 700);
        std::ranges::generate(values, random);
        vk::Buffer buffer(device, 4 * values.size(), vk::BufferUse::Upload, "values");
        std::ranges::copy(values, buffer.map<uint32_t>().begin());
        kept.push_back({std::move(buffer), std::move(values)});
    };
    for (int i = 0; i < 6000; i++) add();
#ifndef RELUME_SANITIZE
    CHECK(device.memory().allocations() - before <= 2);
#endif
    // Holes are filled again, and whatever lies beside them stays.
    for (int round = 0; round < 3; round++) {
        std::ranges::shuffle(kept, random);
        kept.resize(kept.size() / 2);
        for (int i = 0; i < 3000; i++) add();
        for (const Kept& each : kept) REQUIRE(std::ranges::equal(each.buffer.map<uint32_t>(), each.values));
    }
    const auto onDevice = vk::upload<uint32_t>(device, kept[0].values, "on the device");
    CHECK(vk::download<uint32_t>(device, onDevice, kept[0].values.size()) == kept[0].values);
    kept.clear();
    CHECK(device.memory().allocations() <= before + 3); // one block of a kind is kept
}

TEST_CASE("memory: what is large has an allocation of its own, which goes with it") {
    const TestDevice validated;
    const vk::Device& device = validated;
    const size_t before = device.memory().allocations();
    {
        const vk::Buffer large(device, vk::MemoryPool::kLargestShared + 1, vk::BufferUse::Device, "large");
        CHECK_EQ(device.memory().allocations(), before + 1);
    }
    CHECK_EQ(device.memory().allocations(), before);
}
