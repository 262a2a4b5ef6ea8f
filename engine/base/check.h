// Checks for bugs: conditions that only a mistake in this program can break.
// They stay on in every build, print both values and abort. Bad input is not a bug: see error.h.
#pragma once

#include <fmt/format.h>
#include <string_view>

namespace relume {

// Prints the failed condition with its place and aborts.
[[noreturn]] void failCheck(std::string_view condition, std::string_view values, const char* file, int line);

} // namespace relume

#define RELUME_CHECK(condition)                                                                              \
    do {                                                                                                     \
        if (!(condition)) ::relume::failCheck(#condition, "", __FILE__, __LINE__);                           \
    } while (false)

#define RELUME_CHECK_OP(a, op, b)                                                                            \
    do {                                                                                                     \
        const auto& checkLeft = (a);                                                                         \
        const auto& checkRight = (b);                                                                        \
        if (!(checkLeft op checkRight))                                                                      \
            ::relume::failCheck(#a " " #op " " #b, fmt::format("{} against {}", checkLeft, checkRight),      \
                                __FILE__, __LINE__);                                                         \
    } while (false)

#define RELUME_CHECK_EQ(a, b) RELUME_CHECK_OP(a, ==, b)
#define RELUME_CHECK_LE(a, b) RELUME_CHECK_OP(a, <=, b)
#define RELUME_CHECK_LT(a, b) RELUME_CHECK_OP(a, <, b)
