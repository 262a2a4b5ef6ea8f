#include "engine/render/pixel_samples.h"

#include "engine/base/error.h"
#include "shaders/shared/render.h"

#include <bit>
#include <fmt/core.h>

namespace relume {

void expectSamples(int samples) {
    if (samples < 1 || samples > kMostSamples || !std::has_single_bit(unsigned(samples)))
        throw UsageError(fmt::format("{} samples a pixel: must be 1, 2, 4 or 8", samples));
}

vec2 samplePosition(int samples, int i) {
    if (samples == 1) return vec2(0.5f);
    const auto [x, y] = samples == 2   ? std::pair(shared::kSampleX2, shared::kSampleY2)
                        : samples == 4 ? std::pair(shared::kSampleX4, shared::kSampleY4)
                                       : std::pair(shared::kSampleX8, shared::kSampleY8);
    return vec2(x >> 4 * i & 15, y >> 4 * i & 15) / 16.0f;
}

std::vector<uint32_t> groupSamples(std::span<const uint32_t> seen,
                                   const std::function<bool(uint32_t, uint32_t)>& isOne) {
    uint32_t left = 0;
    for (size_t i = 0; i < seen.size(); i++) left |= uint32_t(seen[i] != 0) << i;
    std::vector<uint32_t> groups;
    while (left != 0) {
        const auto first = size_t(std::countr_zero(left));
        uint32_t members = 1u << first;
        for (size_t i = first + 1; i < seen.size(); i++)
            if ((left >> i & 1) && isOne(seen[first], seen[i])) members |= 1u << i;
        groups.push_back(members);
        left &= ~members;
    }
    return groups;
}

} // namespace relume
