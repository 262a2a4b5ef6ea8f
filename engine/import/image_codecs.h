// Decoders and encoders behind image_file.h, between bytes in memory and pixels. Internal to the engine.
#pragma once

#include "engine/import/image_file.h"
#include "engine/scene/texture.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace relume {

bool isExr(std::span<const std::byte> bytes);
bool isRadiance(std::span<const std::byte> bytes);
bool isPng(std::span<const std::byte> bytes);

// Decodes a file's bytes as readImage() does; `name` names the file in errors.
ImageFile decodeImage(std::span<const std::byte> bytes, const std::string& name);

// Decode one format each. Pixels may be infinite or NaN. Throw Error.
ImageFile decodeExr(std::span<const std::byte> bytes, const std::string& name);
Image decodeRadiance(std::span<const std::byte> bytes, const std::string& name);

std::vector<std::byte> encodeExr(const Image& image);

// Decodes a PNG file, its colors as they are stored; `missingAlpha` is the alpha of all texels if it has
// none. Throws Error.
Texture decodePng(std::span<const std::byte> bytes, const std::string& name, uint8_t missingAlpha);

// Encodes texels of four bytes, red, green, blue and alpha, row by row; `name` names the file in errors.
// Throws Error.
std::vector<std::byte> encodePng(int width, int height, std::span<const uint8_t> texels,
                                 const std::string& name);

// Throws Error unless an image of width × height may come from a file of `bytes` bytes: it must not be empty,
// nor over 2^28 pixels or 65536 a side, nor far beyond what compression can reach, so that a small file
// cannot take much memory.
void checkImageSize(const std::string& name, int64_t width, int64_t height, size_t bytes);

// A stricter check for float pixels, which take sixteen bytes each in memory: zeros compress a thousandfold.
void checkDensity(const std::string& name, int64_t width, int64_t height, size_t bytes);

// Throws Error as checkImageSize() does, and for more than kLongestTextureSide a side.
void checkTextureSize(const std::string& name, int64_t width, int64_t height, size_t bytes);

} // namespace relume
