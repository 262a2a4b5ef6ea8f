#include "engine/render/tone_map.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

Image even(float radiance, float alpha = 1) {
    Image image(40, 30);
    for (vec4& pixel : image.pixels) pixel = vec4(vec3(radiance * alpha), alpha);
    return image;
}

} // namespace

TEST_CASE("auto exposure: brings what is covered to its key, to a hundredth of a stop") {
    for (const float radiance : {0.3f, 1.0f, 37.0f, 0.002f}) {
        const float stops = autoExposure(even(radiance));
        CHECK_LT(std::abs(radiance * std::exp2(stops) / 0.3f - 1), 0.004f);
        CHECK_EQ(stops, float(std::round(100 * double(stops)) / 100));
        CHECK_EQ(autoExposure(even(radiance, 0.3f)), stops); // premultiplied
    }
    Image image = even(1);
    for (size_t i = 0; i < image.pixels.size() / 2; i++) image.pixels[i] = vec4(vec3(0.25f), 1);
    CHECK(autoExposure(image) ==
          doctest::Approx(std::log2(0.3 / 0.5)).epsilon(0.005));                // the logarithms' mean
    for (size_t i = 0; i < image.pixels.size() / 2; i++) image.pixels[i].w = 0; // behind the object
    CHECK_EQ(autoExposure(image), autoExposure(even(1)));
}

TEST_CASE("auto exposure: highlights, black and broken pixels do not decide") {
    Image image = even(1);
    for (size_t i = 0; i < image.pixels.size(); i += 100) image.pixels[i] = vec4(vec3(1e6f), 1);
    CHECK_EQ(autoExposure(image), autoExposure(even(1)));
    for (size_t i = 1; i < image.pixels.size(); i += 3) image.pixels[i] = vec4(0, 0, 0, 1);
    CHECK_EQ(autoExposure(image), autoExposure(even(1)));
    image.pixels[2] = vec4(NAN, 1, 1, 1);
    image.pixels[5] = vec4(INFINITY, 1, 1, 1);
    CHECK_EQ(autoExposure(image), autoExposure(even(1)));
    CHECK_EQ(autoExposure(even(0)), 0);
    CHECK_EQ(autoExposure(even(1, 0)), 0);
    CHECK_EQ(autoExposure(Image{}), 0);
    CHECK_EQ(autoExposure(even(1e-30f)), 20);
}
