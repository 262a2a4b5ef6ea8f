// Checks for bugs: conditions that only a mistake in this program can break. They stay on in every build,
// print the condition and its values, and abort. Bad input is not a bug: see error.h.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

namespace relume {

// Prints the failed condition, its values and its place in the source, then aborts.
[[noreturn]] void failCheck(std::string_view condition, std::string_view values, const char* file, int line);

// Returns a value as text, for the message of a failed check.
template <typename T>
std::string printed(const T& value) {
    if constexpr (std::is_arithmetic_v<T>)
        return std::to_string(value);
    else
        return std::string(value);
}

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
            ::relume::failCheck(#a " " #op " " #b,                                                           \
                                ::relume::printed(checkLeft) + " against " + ::relume::printed(checkRight),  \
                                __FILE__, __LINE__);                                                         \
    } while (false)

#define RELUME_CHECK_EQ(a, b) RELUME_CHECK_OP(a, ==, b)
#define RELUME_CHECK_LE(a, b) RELUME_CHECK_OP(a, <=, b)
#define RELUME_CHECK_LT(a, b) RELUME_CHECK_OP(a, <, b)
