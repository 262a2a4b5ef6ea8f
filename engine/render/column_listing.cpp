#include "engine/render/column_listing.h"

#include "engine/base/error.h"
#include "shaders/shared/render.h"

namespace relume {

uint32_t listingLanes(const vk::Device& device) {
    const vk::DeviceInfo& info = device.info();
    if (!info.takesPortableShaders()) return info.subgroupSize;
    return info.isSoftware ? 8 : 32;
}

vk::ComputeProgram makeListingProgram(const vk::Device& device, std::span<const uint32_t> spirv,
                                      std::string_view name) {
    using enum vk::ComputeProgram::Subgroups;
    return {device, spirv, {listingLanes(device)}, name, device.info().takesPortableShaders() ? Any : Full};
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
