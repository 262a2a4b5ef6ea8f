#include "engine/render/column_listing.h"

#include "engine/base/error.h"
#include "shaders/shared/render.h"

namespace relume {

namespace {

constexpr uint32_t kLeastLanes = 8, kMostLanes = 64; // of the kernels

} // namespace

uint32_t listingLanes(const vk::Device& device, TransportLayout layout) {
    const uint32_t lanes = device.info().subgroupSize;
    if (!device.info().subgroupBallot || lanes % kLeastLanes != 0 || lanes > kMostLanes)
        throw Error(
            "{}: relighting {} needs subgroups of {} to {} invocations that can vote; convert the bake "
            "to rows: `relume convert --layout rows`",
            device.name(), layoutName(layout), kLeastLanes, kMostLanes);
    return lanes;
}

std::vector<uint32_t> inPairs(std::span<const uint16_t> indices, uint32_t coefficients) {
    std::vector<uint32_t> words((indices.size() + 1) / 2, 0);
    for (size_t i = 0; i < indices.size(); i++) {
        RELUME_CHECK_LT(uint32_t(indices[i]), coefficients);
        words[i / 2] |= uint32_t(indices[i]) << i % 2 * 16;
    }
    return words;
}

uint32_t pushed(RelightMode mode) {
    switch (mode) {
    case RelightMode::Full:
        return shared::kRelightFull;
    case RelightMode::Incremental:
        return shared::kRelightIncremental;
    case RelightMode::Auto:
        break;
    }
    return shared::kRelightAuto;
}

} // namespace relume
