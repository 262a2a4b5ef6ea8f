// Measures how much memory the program uses.
#pragma once

#include <cstdint>

namespace relume {

// Returns the bytes of main memory in use (with software devices, including what is "on the device"), or 0 if
// the system does not tell.
uint64_t memoryInUse();

} // namespace relume
