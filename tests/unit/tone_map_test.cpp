#include "engine/render/tone_map.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>

using namespace relume;

namespace {

vec4 mapped(vec4 pixel, ToneCurve curve, float stops = 0) {
    Image image(1, 1);
    image.pixels[0] = pixel;
    return toneMap(image, curve, stops).pixels[0];
}

} // namespace

TEST_CASE("tone map: without a curve it is exposure and sRGB") {
    CHECK(mapped(vec4(0.214041f), ToneCurve::None).x == doctest::Approx(0.5).epsilon(1e-5));
    CHECK(mapped(vec4(0.001f), ToneCurve::None).y == doctest::Approx(0.01292).epsilon(1e-5));
    CHECK(mapped(vec4(0.214041f / 4), ToneCurve::None, 2).z == doctest::Approx(0.5).epsilon(1e-5));
    CHECK(mapped(vec4(0.3f), ToneCurve::None).w == 0.3f);
}

TEST_CASE("tone map: ACES and AgX at known points") {
    // 0.18 (2.51 · 0.18 + 0.03) / (0.18 (2.43 · 0.18 + 0.59) + 0.14) = 0.266897, encoded as sRGB.
    CHECK(mapped(vec4(0.18f), ToneCurve::Aces).x == doctest::Approx(0.553459).epsilon(1e-4));
    // AgX shows middle gray near the middle of the display's range.
    CHECK(mapped(vec4(0.18f), ToneCurve::Agx).x == doctest::Approx(0.46).epsilon(0.05));
    // Gray stays gray; a bright saturated light loses color.
    const vec4 gray = mapped(vec4(0.5f), ToneCurve::Agx),
               red = mapped(vec4(50, 0.1f, 0.1f, 1), ToneCurve::Agx);
    CHECK(std::abs(gray.x - gray.z) < 2e-3f);
    CHECK(red.y > 0.3f);
}

TEST_CASE("tone map: rises with the light and ends in [0, 1]") {
    for (ToneCurve curve : {ToneCurve::None, ToneCurve::Aces, ToneCurve::Agx}) {
        float last = -1;
        for (float light : {0.0f, 1e-6f, 1e-3f, 0.1f, 1.0f, 10.0f, 1e4f, 1e20f, 3e38f}) {
            const float value = mapped(vec4(light), curve).x;
            CHECK(value >= last);
            CHECK(value >= 0);
            CHECK(value <= 1);
            last = value;
        }
        CHECK(last > 0.98f);
    }
}

TEST_CASE("tone map: what is no light is black") {
    const float infinity = std::numeric_limits<float>::infinity();
    for (ToneCurve curve : {ToneCurve::None, ToneCurve::Aces, ToneCurve::Agx}) {
        const vec4 pixel = mapped(vec4(-1, std::nanf(""), infinity, 1), curve);
        const float black = mapped(vec4(0), curve).x;
        CHECK(black < 0.02f);
        CHECK(pixel.x >= 0);
        CHECK(pixel.y >= 0);
        CHECK(pixel.z <= 1);
        CHECK(mapped(vec4(0), curve, 1e9f).x == black);
    }
}

TEST_CASE("tone map: names") {
    CHECK(toneCurveFromName("none") == ToneCurve::None);
    CHECK(toneCurveFromName("aces") == ToneCurve::Aces);
    CHECK(toneCurveFromName("agx") == ToneCurve::Agx);
    CHECK(!toneCurveFromName("filmic"));
}
