// Helpers for tests of what an error says.
#pragma once

#include "engine/base/error.h"

#include <string>

namespace relume::test {

// Returns what the Error says that `run` throws; "" if it throws none. Other exceptions pass.
template <typename Run>
std::string failureOf(const Run& run) {
    try {
        run();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

inline bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace relume::test
