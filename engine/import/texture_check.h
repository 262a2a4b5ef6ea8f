// Checks of PNG and JPEG files that their decoder leaves out: it takes what a truncated file lacks for zeros,
// and trusts a JPEG file's tables to fit and to be there. What passes is whole, though its pixels may be
// wrong.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace relume {

bool isPng(std::span<const std::byte> bytes);
bool isJpeg(std::span<const std::byte> bytes);

// Each throws Error, in which `name` stands for the file, unless segments follow one another up to the end of
// the image, which is of no more than kLongestTextureSide a side, and a PNG file's check sums, a JPEG file's
// Huffman and quantization tables, are sound.
void checkPng(std::span<const std::byte> bytes, const std::string& name);
void checkJpeg(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
