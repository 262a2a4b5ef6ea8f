#include "engine/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace relume {

void failCheck(std::string_view condition, std::string_view values, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: check failed: %s%s%s\n", file, line, std::string(condition).c_str(),
                 values.empty() ? "" : ": ", std::string(values).c_str());
    std::abort();
}

} // namespace relume
