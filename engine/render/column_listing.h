// What kernels that list columns, shaders/lib/column_list.glsl, ask of the host.
#pragma once

#include "engine/render/set_relighter.h"
#include "engine/transport/transport.h"

#include <span>
#include <vector>

namespace relume {

// Returns the group size of these kernels: a subgroup, or 8 to 32 invocations of portable shaders.
uint32_t listingLanes(const vk::Device& device);

// Makes the program of such a kernel.
vk::ComputeProgram makeListingProgram(const vk::Device& device, std::span<const uint32_t> spirv,
                                      std::string_view name);

// Column indices, all below `coefficients`, two a word.
std::vector<uint32_t> inPairs(std::span<const uint16_t> indices, uint32_t coefficients);

// As the kernels' push constants have it.
uint32_t pushed(RelightMode mode);

} // namespace relume
