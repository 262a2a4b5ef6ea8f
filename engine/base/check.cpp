#include "engine/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace relume {

void failCheck(std::string_view condition, std::string_view values, std::source_location where) {
    fmt::print(stderr, "{}:{}: check failed: {}{}{}\n", where.file_name(), where.line(), condition,
               values.empty() ? "" : ": ", values);
    std::abort();
}

} // namespace relume
