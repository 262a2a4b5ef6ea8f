// How much memory the program uses.
#pragma once

#include <cstdint>

namespace relume {

// Bytes of main memory that it has at the moment (on software devices: with all that is "on the device"); 0
// where the system does not say.
uint64_t memoryInUse();

} // namespace relume
