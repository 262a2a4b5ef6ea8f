// Checks of PNG and JPEG files that their decoder omits: it reads zeros for what a truncated file lacks, and
// assumes that a JPEG file's tables exist and are valid. A file that passes is complete, though its pixels
// may be wrong.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace relume {

bool isPng(std::span<const std::byte> bytes);
bool isJpeg(std::span<const std::byte> bytes);

// Throw Error, in which `name` names the file, unless segments follow one another up to the end of the image,
// its sides are at most kLongestTextureSide, and a PNG file's checksums, or a JPEG file's Huffman and
// quantization tables, are valid.
void checkPng(std::span<const std::byte> bytes, const std::string& name);
void checkJpeg(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
