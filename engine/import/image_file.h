// Image files: reads OpenEXR and Radiance .hdr, writes OpenEXR (32-bit float) and PNG.
#pragma once

#include "engine/image/image.h"

namespace relume {

// How a file maps directions to pixels, if it says so (OpenEXR's "envmap" attribute).
enum class ImageProjection { None, LatLong, Cube };

struct ImageFile {
    Image image;
    ImageProjection projection = ImageProjection::None;
};

// Reads .exr or .hdr, told apart by content. Pixels that are not finite become 0 and are counted in the log.
// Throws Error if the file is truncated, corrupt, empty or absurd (more than 2^28 pixels).
ImageFile readImage(const std::filesystem::path& path);

// Writes RGBA, 32-bit float, ZIP-compressed, atomically. Throws Error.
void writeExr(const std::filesystem::path& path, const Image& image);

// Writes display values in [0, 1], rounded to nearest, as 8-bit RGBA, atomically. Throws Error.
void writePng(const std::filesystem::path& path, const Image& image);

} // namespace relume
