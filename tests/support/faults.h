// What the libraries of faults share.
#pragma once

#include <cstdlib>
#include <dlfcn.h>

namespace relume::test {

// Returns the number in an environment variable, or 0.
inline int number(const char* name) {
    const char* text = std::getenv(name);
    return text ? std::atoi(text) : 0;
}

// Returns the function that is overridden.
template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

} // namespace relume::test
