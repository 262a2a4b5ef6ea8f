// Checks of JPEG files that their decoder omits: it reads zeros for what a truncated file lacks, and assumes
// that tables exist and are valid. A file that passes is complete, though its pixels may be wrong.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace relume {

bool isJpeg(std::span<const std::byte> bytes);

// Throws Error, in which `name` names the file, unless segments follow one another up to the end of the
// image, and Huffman and quantization tables are valid.
void checkJpeg(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
