// Checks of OpenEXR files that their library omits. Internal to the engine.
#pragma once

#include <OpenEXR/ImfForward.h>
#include <cstddef>
#include <span>
#include <string>

namespace relume {

// Returns the number of bytes of a one-part file's header. Throws Error, in which `name` names the file,
// unless its attributes have sizes that fit their types.
size_t checkExrHeader(std::span<const std::byte> bytes, const std::string& name);

// Throws Error unless every chunk of a one-part file is where the library looks for it, and unpacks to all of
// its pixels or is of a compression of which the library checks that (of DWAA and DWAB not always). `header`
// is the file's, of `headerBytes` bytes. The library must not rebuild the table of chunks:
// InputFile::isComplete().
void checkExrChunks(std::span<const std::byte> bytes, size_t headerBytes, const Imf::Header& header,
                    bool isTiled, const std::string& name);

} // namespace relume
