// The origin of what is baked.
#pragma once

#include <string>

namespace relume {

// An input file, for provenance.
struct InputFile {
    std::string file;
    std::string hash; // hashText of its bytes
};

} // namespace relume
