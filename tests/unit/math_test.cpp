// Tests the CPU definitions in engine/math against closed forms.
#include "engine/math/cubemap.h"
#include "engine/math/disk_map.h"
#include "engine/math/haar.h"
#include "engine/math/tangent_frame.h"

#include <doctest/doctest.h>
#include <random>
#include <vector>

using namespace relume;

TEST_CASE("cubemap: solid angles sum to the sphere") {
    for (int size : {64, 256}) {
        float sum = 0;
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) sum += 6 * cubeTexelSolidAngle(x, y, size);
        CHECK(sum == doctest::Approx(4 * kPi).epsilon(1e-4));
    }
}

TEST_CASE("cubemap: a texel's direction leads back to it") {
    const int size = 32;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const CubeTexel texel = cubeTexel(cubeTexelDirection(face, x, y, size), size);
                CHECK(cubeTexelIndex(texel.face, texel.x, texel.y, size) == cubeTexelIndex(face, x, y, size));
            }
}

TEST_CASE("tangent frame: orthonormal and right-handed everywhere, the pole included") {
    std::mt19937 random(1);
    std::normal_distribution<float> gauss;
    std::vector<vec3> normals = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}};
    for (int i = 0; i < 1000; i++)
        normals.push_back(glm::normalize(vec3(gauss(random), gauss(random), gauss(random))));
    for (float tilt : {1e-2f, 1e-4f, 1e-6f}) normals.push_back(glm::normalize(vec3(tilt, -1, tilt)));
    for (const vec3& n : normals) {
        const TangentFrame frame = tangentFrame(n);
        CHECK(glm::length(frame.s) == doctest::Approx(1).epsilon(1e-5));
        CHECK(glm::length(frame.t) == doctest::Approx(1).epsilon(1e-5));
        CHECK(std::abs(glm::dot(frame.s, n)) < 1e-5f);
        CHECK(glm::dot(glm::cross(frame.s, frame.t), n) == doctest::Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("haar: keeps energy, and its inverse undoes it") {
    const int size = 64;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<vec3> values(size * size);
    for (vec3& value : values) value = {uniform(random), uniform(random), uniform(random)};
    std::vector<vec3> transformed = values;
    haarForward(transformed, size);
    double before = 0, after = 0;
    for (int i = 0; i < size * size; i++) {
        before += glm::dot(values[i], values[i]);
        after += glm::dot(transformed[i], transformed[i]);
    }
    CHECK(after == doctest::Approx(before).epsilon(1e-5));
    haarInverse(transformed, size);
    for (int i = 0; i < size * size; i++) CHECK(glm::length(transformed[i] - values[i]) < 1e-5f);
}

TEST_CASE("haar: a constant is one coefficient") {
    const int size = 32;
    std::vector<vec3> values(size * size, vec3(1, 2, 3));
    haarForward(values, size);
    CHECK(glm::length(values[0] - vec3(1, 2, 3) * float(size)) < 1e-3f);
    for (size_t i = 1; i < values.size(); i++) CHECK(glm::length(values[i]) < 1e-4f);
}

TEST_CASE("disk maps: a direction's coordinates lead back to it") {
    for (DiskMapping mapping :
         {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar, DiskMapping::EqualArea, DiskMapping::Polar})
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 16; x++) {
                const vec2 coordinates((float(x) + 0.5f) / 16, (float(y) + 0.5f) / 16);
                const auto direction = diskMapDirection(mapping, coordinates);
                if (!direction) continue;
                CHECK(glm::length(*direction) == doctest::Approx(1).epsilon(1e-5));
                CHECK(glm::length(diskMapCoordinates(mapping, *direction) - coordinates) < 1e-4f);
            }
}

TEST_CASE("disk maps: solid angles sum to the hemisphere") {
    for (DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar,
                                DiskMapping::EqualArea, DiskMapping::Polar}) {
        constexpr int kSize = 256;
        double sum = 0;
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) {
                const vec2 coordinates = (vec2(x, y) + 0.5f) / float(kSize);
                if (diskMapDirection(mapping, coordinates))
                    sum += double(diskMapSolidAngle(mapping, coordinates)) / (kSize * kSize);
            }
        // Where places go by the sine of the angle, texels at the rim are stretched without bound.
        const bool isBySine = mapping == DiskMapping::Orthographic || mapping == DiskMapping::Polar;
        CHECK(sum == doctest::Approx(2 * kPi).epsilon(isBySine ? 0.03 : 1e-3));
    }
}

TEST_CASE("disk maps: the polar map's radius is the sine of the angle") {
    const vec2 place = diskMapCoordinates(DiskMapping::Polar, {0, std::sin(0.3f), std::cos(0.3f)});
    CHECK(place.x == doctest::Approx(0.75));
    CHECK(place.y == doctest::Approx(std::sin(0.3)));
}

TEST_CASE("disk maps: 48 x 48 orthographic texels hold 1804 directions") {
    int inside = 0;
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 48; x++)
            inside += diskMapDirection(DiskMapping::Orthographic, (vec2(x, y) + 0.5f) / 48.0f).has_value();
    CHECK(inside == 1804);
}
