#include "engine/base/error.h"
#include "engine/import/environment_file.h"
#include "engine/import/image_file.h"
#include "engine/light/environment.h"
#include "tests/support/temporary_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

const test::TemporaryFolder folder;

Environment constant(int width, int height, vec3 radiance) {
    return {width, height, std::vector<vec3>(size_t(width) * size_t(height), radiance)};
}

// Σ radiance · exact solid angle, of the first channel.
double irradianceSum(const Environment& map) {
    const double pi = std::acos(-1.0);
    double sum = 0;
    for (int y = 0; y < map.height; y++) {
        double row = 0;
        for (int x = 0; x < map.width; x++)
            row += double(map.radiance[size_t(y) * size_t(map.width) + size_t(x)].x);
        // cos a - cos b without cancellation
        sum +=
            row * 4 * pi / map.width * std::sin(pi * (y + 0.5) / map.height) * std::sin(pi / map.height / 2);
    }
    return sum;
}

// A smooth radiance that tells all directions apart.
vec3 directional(vec3 d) { return vec3(2) + glm::normalize(d); }

void writeEnvmap(const std::filesystem::path& path, const Image& image, Imf::Envmap kind) {
    Imf::Header header(image.width, image.height);
    Imf::addEnvmap(header, kind);
    Imf::FrameBuffer source;
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        source.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &image.pixels[0].x + c, header.dataWindow(),
                                                 sizeof(vec4), sizeof(vec4) * size_t(image.width)));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(source);
    file.writePixels(image.height);
}

void checkDirectional(const Environment& map, float tolerance) {
    float worst = 0;
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            const vec3 expected = directional(map.direction(float(x) + 0.5f, float(y) + 0.5f));
            const vec3 found = map.radiance[size_t(y) * size_t(map.width) + size_t(x)];
            worst = std::max(worst, glm::length(found - expected));
        }
    CHECK(worst < tolerance);
}

} // namespace

TEST_CASE("environment: the axes lie where OpenEXR's latlong has them") {
    const Environment map = constant(64, 32, vec3(0));
    const auto near = [](vec2 a, vec2 b) { return glm::length(a - b) < 1e-3f; };
    CHECK(near(map.place({0, 0, 1}), {32, 16}));
    CHECK(near(map.place({1, 0, 0}), {16, 16}));
    CHECK(near(map.place({-1, 0, 0}), {48, 16}));
    CHECK(map.place({0, 1, 0}).y == 0);
    CHECK(map.place({0, -1, 0}).y == doctest::Approx(32));
    CHECK(glm::length(map.direction(16, 16) - vec3(1, 0, 0)) < 1e-6f);
    const Imath::V2f latLong = Imf::LatLongMap::latLong(Imath::V3f(0.3f, 0.5f, -0.7f));
    const vec2 place = map.place({0.3f, 0.5f, -0.7f});
    CHECK(place.x == doctest::Approx(32 - 64 * latLong.y / (2 * kPi)).epsilon(1e-4));
    CHECK(place.y == doctest::Approx(16 - 32 * latLong.x / kPi).epsilon(1e-4));
}

TEST_CASE("environment: a pixel's direction leads back to it") {
    const Environment map = constant(40, 20, vec3(0));
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 40; x++) {
            const vec2 center(float(x) + 0.5f, float(y) + 0.5f);
            CHECK(glm::length(map.place(3.0f * map.direction(center.x, center.y)) - center) < 1e-3f);
        }
}

TEST_CASE("environment: lookups are bilinear and wrap in longitude") {
    Environment map = constant(8, 4, vec3(0));
    map.radiance[2 * 8 + 0] = vec3(4);
    CHECK(map.lookup(map.direction(0.5f, 2.5f)).x == doctest::Approx(4).epsilon(1e-4));
    CHECK(map.lookup(map.direction(1.0f, 2.5f)).x == doctest::Approx(2).epsilon(1e-4));
    CHECK(map.lookup(map.direction(0.0f, 2.5f)).x == doctest::Approx(2).epsilon(1e-4));
    CHECK(map.lookup(map.direction(7.75f, 2.5f)).x == doctest::Approx(1).epsilon(1e-4));
    CHECK(map.lookup(map.direction(0.5f, 2.0f)).x == doctest::Approx(2).epsilon(1e-4));
    CHECK(map.lookup({0, 1, 0}).x == 0);
    CHECK(constant(1, 1, vec3(5)).lookup({1, 2, 3}).x == 5);
}

TEST_CASE("environment: a latlong with its rows on the poles is resampled to pixel centers") {
    Image image(64, 33);
    const Imath::Box2i window({0, 0}, {63, 32});
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const Imath::V3f d = Imf::LatLongMap::direction(window, Imath::V2f(float(x), float(y)));
            image.at(x, y) = vec4(directional({d.x, d.y, d.z}), 1);
        }
    writeEnvmap(folder.path() / "latlong.exr", image, Imf::ENVMAP_LATLONG);
    checkDirectional(readEnvironment(folder.path() / "latlong.exr"), 0.005f);
}

TEST_CASE("environment: a cube becomes a latlong of the same directions") {
    const int size = 32;
    Image image(size, 6 * size);
    const Imath::Box2i window({0, 0}, {size - 1, 6 * size - 1});
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const Imath::V2f inFace{float(x), float(y)};
                const Imath::V3f d = Imf::CubeMap::direction(Imf::CubeMapFace(face), window, inFace);
                const Imath::V2f pixel = Imf::CubeMap::pixelPosition(Imf::CubeMapFace(face), window, inFace);
                image.at(int(pixel.x), int(pixel.y)) = vec4(directional({d.x, d.y, d.z}), 1);
            }
    writeEnvmap(folder.path() / "cube.exr", image, Imf::ENVMAP_CUBE);
    const Environment map = readEnvironment(folder.path() / "cube.exr");
    CHECK(map.width == 128);
    CHECK(map.height == 64);
    checkDirectional(map, 0.01f);
    writeEnvmap(folder.path() / "point.exr", Image(1, 6), Imf::ENVMAP_CUBE);
    CHECK(readEnvironment(folder.path() / "point.exr").width == 4);
}

TEST_CASE("environment: a file without a projection is a latlong with pixel centers") {
    Image image(4, 2);
    image.at(1, 0) = vec4(1, 2, 3, 1);
    image.at(2, 1) = vec4(-1, 1e30f, 2, 1);
    writeExr(folder.path() / "plain.exr", image);
    const Environment map = readEnvironment(folder.path() / "plain.exr");
    CHECK(map.radiance[1] == vec3(1, 2, 3));
    CHECK(map.radiance[4 + 2].x == 0);
    CHECK(map.radiance[4 + 2].y == 1e12f);
}

TEST_CASE("environment: other shapes are refused") {
    writeExr(folder.path() / "square.exr", Image(16, 16));
    CHECK_THROWS_AS(readEnvironment(folder.path() / "square.exr"), Error);
    writeEnvmap(folder.path() / "cube.exr", Image(4, 20), Imf::ENVMAP_CUBE);
    CHECK_THROWS_AS(readEnvironment(folder.path() / "cube.exr"), Error);
}

TEST_CASE("environment: preparation keeps a point light's energy at any latitude") {
    const int width = 8192, height = 4096;
    Environment map = constant(width, height, vec3(0));
    for (int row : {0, 2047, height - 1}) {
        vec3& pixel = map.radiance[size_t(row) * size_t(width) + size_t(row * 5 % width)];
        pixel = vec3(1000);
        const Environment prepared = prepareForSampling(map, 1024);
        CHECK(prepared.width == 1024);
        CHECK(prepared.height == 512);
        CHECK(irradianceSum(prepared) == doctest::Approx(irradianceSum(map)).epsilon(1e-5));
        pixel = vec3(0);
    }
}

TEST_CASE("environment: preparation keeps energy at any size, and constants") {
    std::mt19937 random(3);
    for (int width : {1, 2, 3, 7, 64, 100, 513, 1000})
        for (int maxWidth : {1, 50, 512}) {
            Environment map = constant(width, std::max(1, width / 2), vec3(0));
            const size_t bright = random() % map.radiance.size();
            map.radiance[bright] = vec3(1);
            const Environment prepared = prepareForSampling(map, maxWidth);
            CHECK(prepared.width == std::min(width, maxWidth));
            CHECK(irradianceSum(prepared) == doctest::Approx(irradianceSum(map)).epsilon(1e-5));
            for (const vec3& radiance :
                 prepareForSampling(constant(width, width, vec3(3)), maxWidth).radiance)
                CHECK(radiance.x == doctest::Approx(3).epsilon(1e-5));
        }
}

TEST_CASE("environment: a prepared pixel near a pole is as wide as one at the equator") {
    Environment map = constant(256, 128, vec3(0));
    const int row = 10;
    map.radiance[row * 256 + 128] = vec3(1);
    const Environment prepared = prepareForSampling(map);
    // Standard deviation in columns of two boxes of 1 / sin(polar angle): √(2/12) of that width.
    double sum = 0, squares = 0;
    for (int x = 0; x < 256; x++) {
        const double value = prepared.radiance[size_t(row * 256 + x)].x;
        sum += value;
        squares += value * (x - 128) * (x - 128);
    }
    const double across = std::sin(kPi * (row + 0.5) / 128);
    CHECK(std::sqrt(squares / sum) * across == doctest::Approx(std::sqrt(2.0 / 12)).epsilon(0.05));
}

TEST_CASE("environment: the built-in sky is finite, bright in its sun, and the same each time") {
    const Environment sky = makeSky(256);
    CHECK(sky.width == 256);
    CHECK(sky.height == 128);
    CHECK(sky.radiance == makeSky(256).radiance);
    float largest = 0, smallest = 1e30f;
    for (const vec3& radiance : sky.radiance) {
        largest = std::max(largest, radiance.x);
        smallest = std::min({smallest, radiance.x, radiance.y, radiance.z});
    }
    CHECK(smallest > 0);
    CHECK(largest > 100);
    CHECK(std::isfinite(irradianceSum(sky)));
    // Resolution changes nothing but detail.
    CHECK(irradianceSum(makeSky(512)) == doctest::Approx(irradianceSum(sky)).epsilon(0.03));
}
