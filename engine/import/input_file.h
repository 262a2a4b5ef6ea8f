// Where what is baked came from.
#pragma once

#include <string>

namespace relume {

// A file that something was made of: for provenance.
struct InputFile {
    std::string file;
    std::string hash; // hashText of its bytes
};

} // namespace relume
