// What a window shows, held against toneMap().
#include "tests/support/displayed.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <limits>
#include <random>

using namespace relume;

namespace {

constexpr float kBackground = 0.2f;

// Radiance over twenty stops; pixels that are not covered, negative, endless or no numbers.
Image sampleImage() {
    Image image(61, 47);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> stops(-12, 8);
    for (vec4& pixel : image.pixels) {
        for (int c = 0; c < 3; c++) pixel[c] = std::exp2(stops(random));
        pixel.w = random() % 5 ? 1.0f : 0.0f;
    }
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    image.pixels[0] = {-1, kInfinity, std::numeric_limits<float>::quiet_NaN(), 1};
    image.pixels[1] = {0, 1e30f, -kInfinity, 1};
    image.pixels[2] = {1e-30f, 0.18f, 1, 1};
    return image;
}

} // namespace

TEST_CASE("display pass: shows what tone mapping on the CPU gives, over the background") {
    const TestDevice device;
    const Image image = sampleImage();
    for (const ToneCurve curve : {ToneCurve::None, ToneCurve::Aces, ToneCurve::Agx})
        for (const float exposure : {0.0f, -2.5f, 3.0f}) {
            CAPTURE(int(curve));
            CAPTURE(exposure);
            const Image right = toneMap(image, curve, exposure);
            const Image shown = test::displayed(device, image, {curve, exposure, vec3(kBackground)});
            float worst = 0;
            for (size_t i = 0; i < image.pixels.size(); i++)
                for (int c = 0; c < 3; c++) {
                    const float expected = image.pixels[i].w == 0 ? kBackground : right.pixels[i][c];
                    worst = std::max(worst, std::abs(shown.pixels[i][c] - expected));
                }
            // Rounding; the shader's own logarithm and power, or lavapipe's.
            CHECK_LT(worst, 0.51f / 255 + (curve == ToneCurve::Agx ? 4e-4f : 2e-3f));
        }
}
