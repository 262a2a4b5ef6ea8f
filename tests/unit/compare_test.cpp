#include "engine/base/error.h"
#include "engine/image/flip.h"
#include "engine/render/compare.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

Image constant(int width, int height, vec3 color) {
    Image image(width, height);
    for (vec4& pixel : image.pixels) pixel = vec4(color, 1);
    return image;
}

Image randomImage(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    Image image(40, 30);
    for (vec4& pixel : image.pixels) pixel = {uniform(random), uniform(random), uniform(random), 1};
    return image;
}

// A dark disc on gray, moved right by `shift` pixels.
Image disc(float shift) {
    Image image(64, 64);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const float distance = std::hypot(float(x) - 32 - shift, float(y) - 32);
            image.at(x, y) = vec4(vec3(distance < 12 ? 0.2f : 0.7f), 1);
        }
    return image;
}

} // namespace

TEST_CASE("compare: closed forms") {
    const Image reference = constant(8, 4, vec3(2)), image = constant(8, 4, vec3(2, 2, 2.5f));
    const ImageDifference difference = compareImages(image, reference);
    CHECK(difference.relativeRmse == doctest::Approx(0.5 / std::sqrt(12.0)));
    CHECK(difference.psnr == doctest::Approx(10 * std::log10(4 / (0.25 / 3))));
    CHECK(difference.maxDifference == doctest::Approx(0.5));
    CHECK(difference.flip > 0);
}

TEST_CASE("compare: equal images do not differ") {
    const ImageDifference difference = compareImages(randomImage(1), randomImage(1));
    CHECK(difference.relativeRmse == 0);
    CHECK(std::isinf(difference.psnr));
    CHECK(difference.maxDifference == 0);
    CHECK(difference.flip == 0);
}

TEST_CASE("compare: refuses what cannot be compared") {
    CHECK_THROWS_AS(compareImages(constant(2, 2, vec3(1)), constant(2, 3, vec3(1))), Error);
    CHECK_THROWS_AS(compareImages(constant(2, 2, vec3(1)), constant(2, 2, vec3(0))), Error);
    CHECK_THROWS_AS(compareImages(Image(), Image()), Error);
    Image broken = constant(2, 2, vec3(1));
    broken.at(1, 0).y = std::nanf("");
    CHECK_THROWS_AS(compareImages(broken, constant(2, 2, vec3(1))), Error);
    CHECK_THROWS_AS(compareImages(constant(2, 2, vec3(1)), broken), Error);
}

TEST_CASE("flip: constant images differ as their colors do") {
    // The paper's scale: green against blue is 1; black against white is 100 in lightness alone.
    const double largest = flipError(constant(16, 16, vec3(0, 1, 0)), constant(16, 16, vec3(0, 0, 1)));
    CHECK(largest == doctest::Approx(1).epsilon(1e-4));
    const double blackWhite = flipError(constant(16, 16, vec3(0)), constant(16, 16, vec3(1)));
    CHECK(blackWhite > 0.95);
    CHECK(blackWhite < 0.98);
    CHECK(flipError(constant(16, 16, vec3(0.5f)), constant(16, 16, vec3(0.5f))) == 0);
}

TEST_CASE("flip: symmetric, small for small shifts and growing with them") {
    const Image a = randomImage(2), b = randomImage(3);
    CHECK(flipError(a, b) == doctest::Approx(flipError(b, a)).epsilon(1e-6));
    const double small = flipError(disc(1), disc(0)), large = flipError(disc(6), disc(0));
    CHECK(small > 0.001);
    CHECK(small < 0.08);
    CHECK(large > 2 * small);
}

TEST_CASE("flip: fine noise that the eye blurs counts less than a coarse pattern of the same contrast") {
    const auto checkers = [](int cell) {
        Image image(64, 64);
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++)
                image.at(x, y) = vec4(vec3((x / cell + y / cell) % 2 ? 0.6f : 0.4f), 1);
        return image;
    };
    const Image gray = constant(64, 64, vec3(0.5f));
    CHECK(flipError(checkers(1), gray) < 0.5 * flipError(checkers(16), gray));
}
