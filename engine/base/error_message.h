// The text of an exception, as people read it.
#pragma once

#include <exception>
#include <new>

namespace relume {

// Returns the exception's own text, which lives as long as it does, or for std::bad_alloc, which has none,
// what happened and what to do. Allocates nothing.
inline const char* errorMessage(const std::exception& failure) {
    if (dynamic_cast<const std::bad_alloc*>(&failure)) return "out of memory; close other programs";
    return failure.what();
}

} // namespace relume
