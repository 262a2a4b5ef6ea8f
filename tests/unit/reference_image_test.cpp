// Tests reference images whose radiance is known without tracing rays.
#include "precompute/reference/reference_image.h"

#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/math/cubemap.h"
#include "engine/math/tangent_frame.h"
#include "precompute/brdf/brdf.h"
#include "tests/support/diffuse_asset.h"

#include <array>
#include <doctest/doctest.h>
#include <memory>

using namespace relume;
using namespace relume::test;

namespace {

LightCube uniformLight(int size, vec3 radiance) {
    return {size, std::vector<vec3>(size_t(6 * size * size), radiance)};
}

// A small image of the asset about the origin, seen from `eye`.
Image render(const Asset& asset, vec3 eye, const LightCube& light, ReferenceOptions options) {
    options.width = 12, options.height = 9;
    return renderReference(asset, Camera{eye, vec3(0), 0.6f}, light, options);
}

// The largest distance of what covered pixels show from `expected`, and how many there are.
struct Deviation {
    float largest = 0;
    int covered = 0;
};
Deviation deviation(const Image& image, vec3 expected) {
    Deviation result;
    for (const vec4& pixel : image.pixels) {
        if (pixel.w == 0) {
            CHECK(pixel == vec4(0));
            continue;
        }
        CHECK(pixel.w <= 1);
        result.largest = std::max(result.largest, glm::length(vec3(pixel) / pixel.w - expected));
        result.covered++;
    }
    return result;
}

const std::array kBrdfs = {ReferenceBrdf::Exact, ReferenceBrdf::Factored};

} // namespace

TEST_CASE("reference image: a diffuse sphere in a furnace has its albedo everywhere") {
    const Asset asset = makeTestAsset({makeDiffusePart(makeSphere(4), 0.5f)});
    for (ReferenceBrdf brdf : kBrdfs) {
        const Image image = render(asset, {0, 0, 5}, uniformLight(16, vec3(1, 2, 3)), {.brdf = brdf});
        const Deviation found = deviation(image, vec3(0.5f, 1, 1.5f));
        CHECK(found.largest < 0.01f * 1.87f);
        CHECK(found.covered > 20);
        CHECK(found.covered < 12 * 9);
    }
}

TEST_CASE("reference image: a plane beside a wall loses half of the sky") {
    Mesh plane = makePlane(2, 4);
    // A wall without end through x = 0, seen from neither side: the eye looks at the plane's left half.
    const Mesh wall = makeQuad({0, -1e3f, -1e3f}, {0, 2e3f, 0}, {0, 0, 2e3f});
    Asset asset = makeTestAsset({makeDiffusePart(plane, 0.8f)});
    append(asset.occluder, wall);
    const Camera camera{{-1e-3f, 1e-2f, 0}, {-1e-3f, 0, 1e-4f}, 0.01f};
    ReferenceOptions options{.width = 3, .height = 3};
    const LightCube light = uniformLight(16, vec3(1));
    for (bool isBaked : {false, true}) {
        options.bakedOccluder = isBaked;
        const Deviation found =
            deviation(renderReference(asset, camera, light, options), vec3(isBaked ? 0.4f : 0.8f));
        CHECK(found.covered == 9);
        CHECK(found.largest < 0.01f);
    }
}

TEST_CASE("reference image: each part has its own material") {
    const Mesh left = makeQuad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0});
    const Mesh right = makeQuad({0, -1, 0}, {1, 0, 0}, {0, 2, 0});
    const Asset asset = makeTestAsset({makeDiffusePart(left, 0.2f), makeDiffusePart(right, 0.6f)});
    for (ReferenceBrdf brdf : kBrdfs) {
        const Image image = render(asset, {0, 0, 5}, uniformLight(16, vec3(1)), {.brdf = brdf});
        CHECK(image.at(4, 4).x == doctest::Approx(0.2).epsilon(0.01));
        CHECK(image.at(7, 4).x == doctest::Approx(0.6).epsilon(0.01));
    }
}

TEST_CASE("reference image: a negative sum of factors is black, not negative") {
    Asset asset = makeTestAsset({makeDiffusePart(makeSphere(2), 0.5f)});
    for (vec3& value : asset.parts[0].sets[0].brdf.viewMaps) value = vec3(-1, 1, -1);
    const Image image = render(asset, {0, 0, 5}, uniformLight(8, vec3(1)), {.brdf = ReferenceBrdf::Factored});
    const vec4 center = image.at(6, 4);
    CHECK(center.x == 0);
    CHECK(center.y > 1);
    CHECK(center.w == 1);
}

TEST_CASE("reference image: under one texel of light, the BRDF at that direction") {
    Asset asset = makeTestAsset({makeDiffusePart(makePlane(2, 1), 0.5f)});
    FactoredBrdf& brdf = asset.parts[0].sets[0].brdf;
    brdf.terms = 2;
    brdf.lightMaps.resize(2 * brdf.mapTexels()), brdf.viewMaps.resize(2 * brdf.mapTexels());
    for (size_t i = 0; i < brdf.lightMaps.size(); i++) {
        brdf.lightMaps[i] = vec3(float(i % 7), 1, float(i % 5));
        brdf.viewMaps[i] = vec3(1, float(i % 3), float(i % 4));
    }
    const int face = 2, x = 6, y = 3, size = 8;
    LightCube light = uniformLight(size, vec3(0));
    light.radiance[size_t(cubeTexelIndex(face, x, y, size))] = vec3(2);
    asset.parts[0].sets[0].materials[0].description =
        R"({"model": "ashikhmin-shirley", "nu": 10, "nv": 100})";
    const std::unique_ptr<Brdf> exact = makeBrdf(asset.parts[0].sets[0].materials[0].description);

    const Camera camera{{1, 2, 3}, vec3(0), 0.6f};
    const TangentFrame frame = tangentFrame({0, 1, 0});
    const vec3 incoming = frame.toLocal(cubeTexelDirection(face, x, y, size));
    const vec3 outgoing = frame.toLocal(glm::normalize(camera.eye));
    const vec3 irradiance = vec3(2.0f * cubeTexelSolidAngle(x, y, size) * incoming.z);
    for (ReferenceBrdf kind : kBrdfs) {
        const Image image =
            renderReference(asset, camera, light,
                            {.width = 1, .height = 1, .samples = 1, .brdf = kind, .raysPerTexelSide = 1});
        const vec3 expected =
            irradiance * (kind == ReferenceBrdf::Exact ? exact->evaluate(incoming, outgoing)
                                                       : evaluate(brdf, incoming, outgoing));
        CHECK(glm::length(vec3(image.at(0, 0)) - expected) < 1e-4f * glm::length(expected));
    }
}

TEST_CASE("reference image: a finer grid of rays resolves a shadow inside one texel") {
    // One lit texel overhead; a roof covers its right half.
    LightCube light = uniformLight(1, vec3(0));
    light.radiance[2] = vec3(1);
    Asset asset = makeTestAsset({makeDiffusePart(makePlane(1e-3f, 1), 1.0f)});
    append(asset.occluder, makeQuad({0, 1, -2}, {2, 0, 0}, {0, 0, 4}));
    asset.visibilityOffset = 1e-6f;
    const Camera camera{{0, 1e-3f, 1e-5f}, vec3(0), 0.01f};
    ReferenceOptions options{.width = 1, .height = 1, .raysPerTexelSide = 8};
    const float open = renderReference(asset, camera, light, options).at(0, 0).x;
    options.bakedOccluder = true;
    const float half = renderReference(asset, camera, light, options).at(0, 0).x;
    CHECK(half == doctest::Approx(open / 2).epsilon(0.01));
}

TEST_CASE("reference image: an environment's pixels light what they face, turned by the rotation") {
    Environment environment{32, 16, std::vector<vec3>(32 * 16, vec3(0))};
    const int column = 16, row = 8; // just right of and below the center, +Z
    environment.radiance[row * 32 + column] = vec3(10);
    const double solidAngle = 2 * double(kPi) / 32 * std::sin(double(kPi) / 16);
    const vec3 source = environment.direction(column + 0.5f, row + 0.5f);
    const vec3 turned(source.z, source.y, -source.x); // a quarter turn: +Z to +X
    const Asset asset = makeTestAsset({makeDiffusePart(makeQuad({0, -1, 1}, {0, 0, -2}, {0, 2, 0}), 0.5f)});
    const Camera camera{{3, 0, 0}, vec3(0), 0.6f};
    const ReferenceOptions options{.width = 3, .height = 3};
    const Image lit = renderReference(asset, camera, environment, kPi / 2, 32, options);
    CHECK(lit.at(1, 1).x ==
          doctest::Approx(10 * solidAngle * 0.5 / double(kPi) * double(turned.x)).epsilon(1e-3));
    const Image dark = renderReference(asset, camera, environment, -kPi / 2, 32, options);
    CHECK(dark.at(1, 1) == vec4(0, 0, 0, 1));
}

TEST_CASE("reference image: a uniform environment is a furnace too") {
    const Environment environment{64, 32, std::vector<vec3>(64 * 32, vec3(1))};
    const Asset asset = makeTestAsset({makeDiffusePart(makeSphere(4), 0.5f)});
    const Image image = renderReference(asset, Camera{{0, 0, 5}, vec3(0), 0.6f}, environment, 0.3f, 64,
                                        {.width = 6, .height = 6});
    const Deviation found = deviation(image, vec3(0.5f));
    CHECK(found.covered > 4);
    CHECK(found.largest < 0.01f);
}

TEST_CASE("reference image: a pixel of several samples is the mean of what they see") {
    // Two materials meet along x = 0, and the left one ends above y = 0.3.
    const Mesh left = makeQuad({-1, -1, 0}, {1, 0, 0}, {0, 1.3f, 0});
    const Mesh right = makeQuad({0, -1, 0}, {1, 0, 0}, {0, 2, 0});
    const Asset asset = makeTestAsset({makeDiffusePart(left, 0.2f), makeDiffusePart(right, 0.6f)});
    const Camera camera{{0.03f, 0.02f, 5}, {0.03f, 0.02f, 0}, 0.6f};
    const LightCube light = uniformLight(16, vec3(1));
    constexpr int kSize = 5;
    for (const int samples : {1, 2, 4, 8}) {
        const Image image =
            renderReference(asset, camera, light, {.width = kSize, .height = kSize, .samples = samples});
        int mixed = 0;
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) {
                vec2 expected(0); // radiance and coverage
                for (int i = 0; i < samples; i++) {
                    const vec2 place = vec2(x, y) + samplePosition(samples, i);
                    const vec3 ray = camera.directionAt(place, kSize, kSize);
                    const vec3 seen = camera.eye - camera.eye.z / ray.z * ray;
                    if (std::abs(seen.x) > 1 || seen.y < -1 || seen.y > (seen.x < 0 ? 0.3f : 1.0f)) continue;
                    expected += vec2(seen.x < 0 ? 0.2f : 0.6f, 1) / float(samples);
                }
                const vec4 pixel = image.at(x, y);
                CHECK(pixel.x == doctest::Approx(expected.x).epsilon(0.01));
                CHECK(pixel.w == expected.y);
                mixed += pixel.w > 0 && pixel.w < 1;
            }
        CHECK((mixed > 0) == (samples > 1));
    }
}

TEST_CASE("reference image: the same twice, with each row reported once") {
    const Asset asset = makeTestAsset({makeDiffusePart(makeTorus(1, 0.4f, 24, 16), 0.5f)});
    const Camera camera{{0, 3, 4}, vec3(0), 0.6f};
    const LightCube light = uniformLight(8, vec3(1));
    std::vector<int> reported;
    const Image first = renderReference(asset, camera, light, {.width = 16, .height = 12},
                                        [&](int rows) { reported.push_back(rows); });
    const Image second = renderReference(asset, camera, light, {.width = 16, .height = 12});
    CHECK(first.pixels == second.pixels);
    REQUIRE(reported.size() == 12);
    for (int i = 0; i < 12; i++) CHECK(reported[size_t(i)] == i + 1);
}

TEST_CASE("reference image: absurd options are refused") {
    const Asset asset = makeTestAsset({makeDiffusePart(makeSphere(0), 0.5f)});
    const LightCube light = uniformLight(2, vec3(1));
    for (const ReferenceOptions& options :
         {ReferenceOptions{.width = 0}, ReferenceOptions{.height = -1}, ReferenceOptions{.width = 1 << 20},
          ReferenceOptions{.samples = 3}, ReferenceOptions{.samples = 16},
          ReferenceOptions{.raysPerTexelSide = 0}, ReferenceOptions{.raysPerTexelSide = 1 << 20}})
        CHECK_THROWS_AS(renderReference(asset, Camera{}, light, options), UsageError);
}
