#include "apps/viewer/memory_use.h"

#include <fstream>
#include <unistd.h>

namespace relume {

uint64_t memoryInUse() {
    std::ifstream file("/proc/self/statm");
    uint64_t whole = 0, resident = 0;
    return file >> whole >> resident ? resident * uint64_t(sysconf(_SC_PAGESIZE)) : 0;
}

} // namespace relume
