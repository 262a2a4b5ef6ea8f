// Image files: OpenEXR and Radiance .hdr in, OpenEXR (32-bit float) and PNG out.
#pragma once

#include "engine/image/image.h"

namespace relume {

// How a file maps directions to pixels, where it says so (OpenEXR's "envmap" attribute).
enum class ImageProjection { None, LatLong, Cube };

struct ImageFile {
    Image image;
    ImageProjection projection = ImageProjection::None;
};

// Reads .exr or .hdr by content. Throws Error for anything truncated, corrupt, absurd (more than
// 2^28 pixels), empty; pixels that are not finite become 0 and are counted in the log.
ImageFile readImage(const std::filesystem::path& path);

// Writes RGBA, 32-bit float, ZIP-compressed, whole or not at all.
void writeExr(const std::filesystem::path& path, const Image& image);

// Writes display values in [0, 1], rounded to nearest, as 8-bit RGBA, whole or not at all.
void writePng(const std::filesystem::path& path, const Image& image);

} // namespace relume
