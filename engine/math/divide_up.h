// Division that rounds up: how many groups hold a number of items.
#pragma once

#include <cstdint>

namespace relume {

constexpr uint32_t divideUp(uint32_t value, uint32_t step) { return (value + step - 1) / step; }

} // namespace relume
