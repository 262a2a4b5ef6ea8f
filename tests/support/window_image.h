// What a window showed, from the .png it wrote, and how two of them differ.
#pragma once

#include "engine/image/image.h"
#include "engine/import/texture_file.h"
#include "engine/scene/texture.h"

#include <doctest/doctest.h>

namespace relume::test {

// Display values in [0, 1].
inline Image windowImage(const std::filesystem::path& file) {
    const Texture texture = readTexture(file, false);
    Image image(texture.width, texture.height);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) image.at(x, y) = fetch(texture, x, y);
    return image;
}

// Pixels of columns [from, to) that are not equal.
inline int differingPixels(const Image& a, const Image& b, int from, int to) {
    REQUIRE_EQ(a.width, b.width);
    REQUIRE_EQ(a.height, b.height);
    int count = 0;
    for (int y = 0; y < a.height; y++)
        for (int x = from; x < to; x++) count += vec3(a.at(x, y)) != vec3(b.at(x, y));
    return count;
}
inline int differingPixels(const Image& a, const Image& b) { return differingPixels(a, b, 0, a.width); }

// Of pixels that `b` covers, over their channels.
inline double meanDifference(const Image& a, const Image& b) {
    REQUIRE_EQ(a.pixels.size(), b.pixels.size());
    double sum = 0, count = 0;
    for (size_t i = 0; i < a.pixels.size(); i++) {
        if (b.pixels[i].w == 0) continue;
        const vec3 d = glm::abs(vec3(a.pixels[i]) - vec3(b.pixels[i]));
        sum += double(d.x + d.y + d.z) / 3;
        count++;
    }
    REQUIRE_GT(count, 0);
    return sum / count;
}

// Mean of all channels of all pixels.
inline double heatOf(const Image& image) {
    double sum = 0;
    for (const vec4& pixel : image.pixels) sum += double(pixel.x + pixel.y + pixel.z) / 3;
    return sum / double(image.pixels.size());
}

} // namespace relume::test
