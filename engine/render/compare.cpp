#include "engine/render/compare.h"

#include "engine/base/error.h"
#include "engine/image/flip.h"
#include "engine/render/tone_map.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>

namespace relume {

namespace {

void checkFinite(const Image& image, const char* which) {
    for (size_t i = 0; i < image.pixels.size(); i++)
        for (int c = 0; c < 3; c++)
            if (!std::isfinite(image.pixels[i][c]))
                throw Error(fmt::format("the {} is not finite at pixel ({}, {})", which,
                                        i % size_t(image.width), i / size_t(image.width)));
}

} // namespace

ImageDifference compareImages(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw Error(fmt::format("expected images of equal size, found {} x {} against {} x {}", image.width,
                                image.height, reference.width, reference.height));
    checkFinite(image, "image");
    checkFinite(reference, "reference");
    double squares = 0, referenceSquares = 0, peak = 0, largest = 0;
    for (size_t i = 0; i < image.pixels.size(); i++)
        for (int c = 0; c < 3; c++) {
            const double b = reference.pixels[i][c], difference = image.pixels[i][c] - b;
            squares += difference * difference;
            referenceSquares += b * b;
            peak = std::max(peak, b);
            largest = std::max(largest, std::abs(difference));
        }
    if (peak <= 0) throw Error("the reference is black: differences cannot be related to it");
    const double meanSquare = squares / (3.0 * double(image.pixels.size()));
    return {.relativeRmse = std::sqrt(squares / referenceSquares),
            .psnr = squares == 0 ? std::numeric_limits<double>::infinity()
                                 : 10 * std::log10(peak * peak / meanSquare),
            .maxDifference = largest,
            .flip = flipError(toneMap(image, ToneCurve::Aces, 0), toneMap(reference, ToneCurve::Aces, 0))};
}

vec3 heatColor(float heat) {
    const float h = 4 * glm::clamp(heat, 0.0f, 1.0f);
    const auto share = [&](float from) { return glm::clamp(h - from, 0.0f, 1.0f); };
    vec3 c = glm::mix(vec3(0), vec3(0.02f, 0.03f, 0.35f), share(0));
    c = glm::mix(c, vec3(0.5f, 0.02f, 0.25f), share(1));
    c = glm::mix(c, vec3(1, 0.3f, 0.01f), share(2));
    return glm::mix(c, vec3(1, 1, 0.6f), share(3));
}

} // namespace relume
