// Decoders and encoders behind image_file.h: bytes in memory to and from pixels. Internal to the engine.
#pragma once

#include "engine/import/image_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace relume {

bool isExr(std::span<const std::byte> bytes);
bool isRadiance(std::span<const std::byte> bytes);

// What readImage() makes of a file's bytes; `name` is the file's name for the text of an Error.
ImageFile decodeImage(std::span<const std::byte> bytes, const std::string& name);

// One format each. Pixels may be infinite or NaN.
ImageFile decodeExr(std::span<const std::byte> bytes, const std::string& name);
Image decodeRadiance(std::span<const std::byte> bytes, const std::string& name);

// Throws Error unless the attributes of an OpenEXR header of one part have the sizes that their types ask
// for.
void checkExrHeader(std::span<const std::byte> bytes, const std::string& name);

std::vector<std::byte> encodeExr(const Image& image);

// Throws Error unless an image of width × height may come from a file of `bytes` bytes: neither empty,
// nor over 2^28 pixels or 65536 a side, nor far beyond what compression can reach, so that a small file
// cannot take a large memory.
void checkImageSize(const std::string& name, int64_t width, int64_t height, size_t bytes);

// The same, for floating pixels, which take sixteen bytes each in memory: zeros compress a thousandfold.
void checkDensity(const std::string& name, int64_t width, int64_t height, size_t bytes);

} // namespace relume
