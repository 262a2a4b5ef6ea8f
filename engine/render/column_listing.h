// What kernels that list columns, shaders/lib/column_list.glsl, ask of the host.
#pragma once

#include "engine/render/set_relighter.h"
#include "engine/transport/transport.h"

#include <span>
#include <vector>

namespace relume {

// Their group size on this device. Throws Error when it has no subgroups that suit; `layout` is the one
// that cannot be relit.
uint32_t listingLanes(const vk::Device& device, TransportLayout layout);

// Column indices, all below `coefficients`, two a word.
std::vector<uint32_t> inPairs(std::span<const uint16_t> indices, uint32_t coefficients);

// As the kernels' push constants have it.
uint32_t pushed(RelightMode mode);

} // namespace relume
