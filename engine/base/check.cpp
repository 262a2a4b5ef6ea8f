#include "engine/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace relume {

void failCheck(std::string_view condition, std::string_view values, const char* file, int line) {
    fmt::print(stderr, "{}:{}: check failed: {}{}{}\n", file, line, condition, values.empty() ? "" : ": ",
               values);
    std::abort();
}

} // namespace relume
