// What a SPIR-V module says about itself: so that C++ never repeats a layout.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace relume::vk {

struct ShaderInterface {
    VkShaderStageFlagBits stage;
    std::map<uint32_t, VkDescriptorType> bindings; // of descriptor set 0, by binding number
    uint32_t pushConstantBytes = 0;
    std::array<uint32_t, 3> groupSize{1, 1,
                                      1}; // compute only, with specialization constants at their given values
};

// Specialization constants: element i is the value of constant_id i. Kernels number theirs from 0.
using Constants = std::vector<uint32_t>;

ShaderInterface reflect(std::span<const uint32_t> spirv, const Constants& constants);

} // namespace relume::vk
