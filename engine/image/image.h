// Float images.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <vector>

namespace relume {

// An RGBA image, row by row from the top. Colors have sRGB primaries and are linear unless a function says
// otherwise; alpha is coverage.
struct Image {
    int width = 0, height = 0;
    std::vector<vec4> pixels;

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(size_t(w) * size_t(h), vec4(0)) {}
    vec4& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    const vec4& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

} // namespace relume
