// Reflection of SPIR-V, so that C++ never repeats a layout.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace relume::vk {

// The resources that a shader declares.
struct ShaderInterface {
    VkShaderStageFlagBits stage;
    std::map<uint32_t, VkDescriptorType> bindings; // of descriptor set 0, by binding number
    uint32_t pushConstantBytes = 0;
    std::array<uint32_t, 3> groupSize{1, 1, 1}; // of compute shaders, specialized
};

// Values of specialization constants: element i is that of constant_id i. Shaders number theirs from 0.
using Constants = std::vector<uint32_t>;

// Returns the interface of a shader specialized with `constants`.
ShaderInterface reflect(std::span<const uint32_t> spirv, const Constants& constants);

} // namespace relume::vk
