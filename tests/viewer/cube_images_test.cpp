// Cubes laid out flat: directions end up where they belong.
#include "apps/viewer/cube_images.h"

#include "engine/light/light.h"
#include "engine/math/cubemap.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

constexpr int kFaceSize = 16;

LightCube brightAt(vec3 direction) {
    LightCube cube{kFaceSize, std::vector<vec3>(size_t(6 * kFaceSize * kFaceSize), vec3(0))};
    const CubeTexel texel = cubeTexel(direction, kFaceSize);
    cube.radiance[size_t(cubeTexelIndex(texel.face, texel.x, texel.y, kFaceSize))] = vec3(1, 2, 3);
    return cube;
}

// Pixels that are not black, their mean; in pixels, a pixel's middle at its half.
vec2 middleOf(const Image& image) {
    vec2 sum(0);
    float count = 0;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            if (image.at(x, y).y > 0) sum += vec2(x, y) + 0.5f, count++;
    REQUIRE_GT(count, 0);
    return sum / count;
}

} // namespace

TEST_CASE("cube images: on a map a direction is where its angles say") {
    const Image map = latlongOf(brightAt({0, 0, 1}), 256);
    CHECK_EQ(map.width, 256);
    CHECK_EQ(map.height, 128);
    CHECK(anglesAt({0.5f, 0.5f}).azimuth == doctest::Approx(0));
    CHECK(anglesAt({0.25f, 0.5f}).azimuth == doctest::Approx(90)); // left of the middle is +X
    CHECK(anglesAt({0.5f, 0}).elevation == doctest::Approx(90));
    for (const float azimuth : {-150.0f, -60.0f, 0.0f, 33.0f, 90.0f, 140.0f})
        for (const float elevation : {-60.0f, -10.0f, 5.0f, 45.0f}) {
            CAPTURE(azimuth);
            CAPTURE(elevation);
            const vec3 direction = directionAt(azimuth, elevation);
            const Image image = latlongOf(brightAt(direction), 256);
            const MapAngles angles = anglesAt(middleOf(image) / vec2(image.width, image.height));
            // A texel is 6 degrees.
            CHECK_GT(glm::dot(directionAt(angles.azimuth, angles.elevation), direction),
                     std::cos(glm::radians(6.0f)));
            CHECK_EQ(image.at(0, 0).w, 1);
        }
    // As environments are laid out.
    const Environment like{256, 128, {}};
    for (const vec2 place : {vec2(0.1f, 0.2f), vec2(0.7f, 0.9f)}) {
        const MapAngles angles = anglesAt(place);
        const vec3 direction = like.direction(256 * place.x, 128 * place.y);
        CHECK(glm::distance(directionAt(angles.azimuth, angles.elevation), direction) < 1e-4f);
    }
}

TEST_CASE("cube images: a cross has its faces side by side, without a seam") {
    const auto placeOf = [](vec3 direction) {
        return middleOf(crossOf(brightAt(direction))) / float(kFaceSize); // in faces
    };
    const auto isAt = [](vec2 place, vec2 expected) { return glm::distance(place, expected) < 0.12f; };
    CHECK(isAt(placeOf({1, 0, 0}), {0.5f, 1.5f}));
    CHECK(isAt(placeOf({0, 0, 1}), {1.5f, 1.5f}));
    CHECK(isAt(placeOf({-1, 0, 0}), {2.5f, 1.5f}));
    CHECK(isAt(placeOf({0, 0, -1}), {3.5f, 1.5f}));
    CHECK(isAt(placeOf({0, 1, 0}), {1.5f, 0.5f}));
    CHECK(isAt(placeOf({0, -1, 0}), {1.5f, 2.5f}));
    CHECK(isAt(placeOf({1, 0, 0.95f}), {1, 1.5f})); // from both sides of the edges
    CHECK(isAt(placeOf({0.95f, 0, 1}), {1, 1.5f}));
    CHECK(isAt(placeOf({-1, 0, 0.95f}), {2, 1.5f}));
    CHECK(isAt(placeOf({-0.95f, 0, 1}), {2, 1.5f}));
    CHECK(isAt(placeOf({-1, 0, -0.95f}), {3, 1.5f}));
    CHECK(isAt(placeOf({-0.95f, 0, -1}), {3, 1.5f}));
    for (const float sign : {1.0f, -1.0f}) { // above, and below
        const float edge = 1.5f - 0.5f * sign;
        CHECK(isAt(placeOf({0, 0.95f * sign, 1}), {1.5f, edge}));
        CHECK(isAt(placeOf({0, sign, 0.95f}), {1.5f, edge}));
        CHECK(isAt(placeOf({0.6f, 0.95f * sign, 1}), {1.2f, edge}));
        CHECK(isAt(placeOf({0.6f, sign, 0.95f}), {1.2f, edge}));
    }

    const Image cross = crossOf(brightAt({0, 0, 1}), 3);
    CHECK_EQ(cross.width, 4 * 3 * kFaceSize);
    CHECK_EQ(cross.height, 3 * 3 * kFaceSize);
    CHECK_EQ(cross.at(0, 0).w, 0);
    CHECK_EQ(cross.at(cross.width - 1, cross.height - 1).w, 0);
    CHECK_EQ(cross.at(0, cross.height / 2).w, 1);
    CHECK_EQ(std::ranges::count_if(cross.pixels, [](vec4 p) { return p == vec4(1, 2, 3, 1); }), 9);
}

TEST_CASE("cube images: a thumbnail averages whole pixels") {
    Environment map{8, 4, {}};
    for (int i = 0; i < 32; i++) map.radiance.emplace_back(float(i));
    const Image half = thumbnailOf(map, 4, 2);
    CHECK_EQ(half.at(0, 0), vec4(vec3((0 + 1 + 8 + 9) / 4.0f), 1));
    CHECK_EQ(half.at(3, 1), vec4(vec3((22 + 23 + 30 + 31) / 4.0f), 1));
    const Image larger = thumbnailOf(map, 16, 8);
    CHECK_EQ(larger.at(15, 7), vec4(vec3(31), 1));
}
