// The validation that tests run under.
#pragma once

#include <cstdlib>
#include <string>

namespace relume {

// Returns the kinds of validation, as `--validation` takes them: core and synchronization, or those that the
// environment variable RELUME_VALIDATION names.
inline std::string testValidation() {
    const char* const kinds = std::getenv("RELUME_VALIDATION");
    return kinds ? kinds : "core,sync";
}

} // namespace relume
