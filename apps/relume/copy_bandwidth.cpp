#include "apps/relume/copy_bandwidth.h"

#include "engine/base/stopwatch.h"
#include "engine/vk/commands.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <thread>

namespace relume {

namespace {

constexpr uint64_t kBytes = 64 << 20;
constexpr int kCopies = 7;

template <typename Copy>
double bestBandwidth(const Copy& copy) {
    copy(); // touches pages and compiles code
    double best = 0;
    for (int i = 0; i < kCopies; i++) {
        const Stopwatch watch;
        copy();
        best = std::max(best, double(2 * kBytes) / watch.seconds());
    }
    return best;
}

} // namespace

double deviceCopyBandwidth(const vk::Device& device) {
    // Submit many copies at once: on a GPU the time of a single one is lost in that of its submission.
    constexpr int kTogether = 8;
    const vk::Buffer from(device, kBytes, vk::BufferUse::Device, "copied from");
    const vk::Buffer to(device, kBytes, vk::BufferUse::Device, "copied to");
    vk::Commands commands(device, "copy bandwidth");
    commands.begin();
    commands.fill(from, 0);
    commands.submitAndWait();
    return kTogether * bestBandwidth([&] {
               commands.begin();
               for (int i = 0; i < kTogether; i++) {
                   commands.barrier(vk::Stage::Transfer, vk::Stage::Transfer);
                   commands.copy(from, to, kBytes);
               }
               commands.submitAndWait();
           });
}

double hostCopyBandwidth(int threads) {
    const auto from = std::make_unique<std::byte[]>(kBytes), to = std::make_unique<std::byte[]>(kBytes);
    const uint64_t share = kBytes / uint64_t(threads);
    return bestBandwidth([&] {
        std::vector<std::jthread> workers;
        for (int i = 0; i < threads; i++)
            workers.emplace_back([&, first = uint64_t(i) * share] {
                std::memcpy(to.get() + first, from.get() + first, share);
            });
    });
}

} // namespace relume
