// Bounced light, from the bake to the image: against closed forms and a path-traced reference.
#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/math/color.h"
#include "engine/render/compare.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "precompute/bake/bake.h"
#include "precompute/error/error_study.h"
#include "precompute/reference/reference_image.h"
#include "precompute/twins/verification.h"
#include "tests/support/bowl.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <fmt/core.h>

using namespace relume;
using namespace relume::test;

namespace {

constexpr int kBounceWidth = 64, kBounceHeight = 48;

LightCube uniformLight(int size) { return {size, std::vector<vec3>(size_t(6 * size * size), vec3(1))}; }

// A low sun and a sky that is brighter on one side.
LightCube sunnyLight(int size) {
    LightCube light{size, {}};
    for (int i = 0; i < 6 * size * size; i++) {
        const int face = i / (size * size);
        light.radiance.push_back(face == 3   ? vec3(0.1f)
                                 : face == 0 ? vec3(1.5f, 1.4f, 1.2f)
                                             : vec3(0.4f, 0.5f, 0.7f));
    }
    return light;
}

BakeOptions bounceOptions(int bounces) {
    BakeOptions options;
    options.bounces = bounces;
    options.faceSize = 32;
    options.visibilitySize = 64;
    options.mapSize = 24;
    options.factorization.terms = 4;
    return options;
}

Asset bakeBowl(const vk::Device& device, float albedo, int bounces) {
    Scene scene;
    scene.parts.push_back(
        {"bowl", makeBowl(24, 10), fmt::format(R"({{"model":"diffuse","albedo":{}}})", albedo), "bowl", ""});
    return bake(device, std::move(scene), bounceOptions(bounces));
}

// A gold torus, tilted, on a red floor beside a white wall.
Scene cornerScene() {
    Scene scene;
    Mesh floor = makePlane(4, 16), wall = makePlane(4, 16);
    for (vec3& position : floor.positions) position.y -= 0.6f;
    for (vec3& position : wall.positions) position = {-1.6f, position.z + 1.4f, position.x};
    std::fill(wall.normals.begin(), wall.normals.end(), vec3(1, 0, 0));
    scene.parts.push_back({"torus", makeTorus(0.9f, 0.35f, 40, 20), "gold", "torus", ""});
    scene.parts.push_back({"floor", floor, R"({"model":"diffuse","albedo":[0.8,0.15,0.1]})", "floor", ""});
    scene.parts.push_back({"wall", wall, "white-diffuse", "wall", ""});
    return scene;
}

Image draw(const vk::Device& device, const Asset& asset, const LightCube& cube, const Camera& camera) {
    LightPass light(device, asset.faceSize);
    light.setCube(cube);
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = kBounceWidth, .height = kBounceHeight, .samples = 1});
    vk::Commands commands(device, "bounce test");
    commands.begin();
    light.record(commands);
    relighter.record(commands, light);
    view.record(commands, camera, relighter);
    commands.submitAndWait();
    return view.read();
}

double meanRadiance(const vk::Device& device, const Asset& asset) {
    const Image image =
        draw(device, asset, uniformLight(asset.faceSize), {{0, 3, 0.01f}, {0, -0.6f, 0}, 0.5f});
    double sum = 0, count = 0;
    for (const vec4& pixel : image.pixels)
        if (pixel.w == 1) sum += double(pixel.x + pixel.y + pixel.z) / 3, count++;
    return sum / count;
}

} // namespace

TEST_CASE("image: a diffuse bowl under an even sky has ρ/2 / (1 - ρ/2)") {
    const TestDevice device;
    for (const float albedo : {0.2f, 0.5f, 0.9f}) {
        const double share = double(albedo) / 2;
        CHECK(meanRadiance(device, bakeBowl(device, albedo, 8)) ==
              doctest::Approx(share / (1 - share)).epsilon(0.02));
    }
}

TEST_CASE("image: in a white furnace every bounce brings a white bowl nearer to the light, from below") {
    const TestDevice device;
    double before = 0;
    for (const int bounces : {0, 1, 2, 4, 8}) {
        const double radiance = meanRadiance(device, bakeBowl(device, 1, bounces));
        CHECK(radiance > before);
        CHECK(radiance < 1);
        CHECK(radiance == doctest::Approx(1 - std::pow(0.5, bounces + 1)).epsilon(0.02));
        before = radiance;
    }
    CHECK(before > 0.98);
}

TEST_CASE("image: bounced light against paths, in gold, red and white") {
    const TestDevice device;
    const Asset direct = bake(device, cornerScene(), bounceOptions(0));
    const Asset bounced = bake(device, cornerScene(), bounceOptions(2));
    CHECK(bounced.bounces == 2);
    const Camera camera{{3.2f, 1.6f, 2.4f}, {-0.4f, -0.1f, 0}, 0.7f};
    const LightCube light = sunnyLight(direct.faceSize);
    ReferenceOptions options;
    options.width = kBounceWidth;
    options.height = kBounceHeight;
    options.samples = 1;
    options.raysPerTexelSide = 1;
    const Image directTruth = renderReference(direct, camera, light, options);
    options.bounces = 2;
    options.paths = 256;
    const Image truth = renderReference(bounced, camera, light, options);
    const double own = compareImages(draw(device, direct, light, camera), directTruth).relativeRmse;
    const double without = compareImages(draw(device, direct, light, camera), truth).relativeRmse;
    const double with = compareImages(draw(device, bounced, light, camera), truth).relativeRmse;
    MESSAGE("direct light against direct paths ", own, ", against bounced paths ", without, ", bounced ",
            with);
    CHECK(without > 2.2 * own);
    CHECK(with < 1.3 * own);
}

TEST_CASE("bounces: shares of direct light are those of even light in each term") {
    const TestDevice device;
    BakeOptions options = bounceOptions(0);
    options.layout.layout = TransportLayout::Rows;
    const Asset direct = bake(device, cornerScene(), options);
    options.bounces = 2;
    const Asset whole = bake(device, cornerScene(), options);
    const MaterialSet &torus = whole.parts[0].sets[0], &own = direct.parts[0].sets[0];
    CHECK(own.directShares.empty());
    CHECK(whole.parts[1].sets[0].directShares.empty()); // diffuse: no residual
    const auto terms = size_t(torus.brdf.terms);
    const size_t coefficients = 6 * size_t(whole.faceSize) * size_t(whole.faceSize);
    const auto response = [&](const Transport& transport, size_t row) {
        const std::vector<vec3> dense = dequantizedRow(transport, row, coefficients);
        vec3 sum(0);
        for (size_t face = 0; face < 6; face++) sum += dense[face * coefficients / 6];
        return double(luminance(sum));
    };
    double least = 1, error = 0;
    const size_t rows = whole.parts[0].mesh.vertexCount() * terms;
    for (size_t row = 0; row < rows; row++) {
        const double all = response(torus.transport, row),
                     share = torus.directShare(row / terms, row % terms);
        least = std::min(least, share);
        error += std::abs(share * all - response(own.transport, row)) / std::max(all, 1e-6) / double(rows);
    }
    CHECK(least < 0.5);
    CHECK(error < 0.02);
}

TEST_CASE("errors: those of bounced light, and of what is beyond it, add up to what is measured") {
    const TestDevice device;
    const Camera camera{{3.2f, 1.6f, 2.4f}, {-0.4f, -0.1f, 0}, 0.7f};
    const auto sky = std::make_shared<const Environment>(prepareForSampling(makeSky()));
    const Light light{.environments = {{sky}}};
    const StudiedLight studied{light, sampleLight(light, kTruthFaceSize), {}};
    const auto study = [&](const Asset& asset, int bounces) {
        const ErrorStudies studies =
            studyErrors(device, asset, defaultAppearance(asset), std::span(&studied, 1),
                        {.view = {camera, 20, 15}, .mostPasses = 128, .bounces = bounces});
        const ErrorStudy& found = studies.lights[0];
        CHECK(found.budget.total == doctest::Approx(found.measured).epsilon(0.1));
        CHECK(found.truthAside < 0.03);
        return found.budget;
    };
    const auto rms = [](const ErrorBudget& budget, ErrorSource source) {
        return budget.sources[size_t(source)].rms;
    };
    const Asset direct = bake(device, cornerScene(), bounceOptions(0));
    const ErrorBudget ofDirect = study(direct, 2);
    CHECK(rms(ofDirect, ErrorSource::Bounces) == 0);
    CHECK(rms(ofDirect, ErrorSource::MoreBounces) > 0.1);
    const Asset bounced = bake(device, cornerScene(), bounceOptions(2));
    const ErrorBudget ofBounced = study(bounced, 2), ofMore = study(bounced, 6);
    CHECK(rms(ofBounced, ErrorSource::Bounces) > 0.002);
    CHECK(rms(ofBounced, ErrorSource::Bounces) < 0.3 * rms(ofDirect, ErrorSource::MoreBounces));
    CHECK(rms(ofBounced, ErrorSource::MoreBounces) == 0);
    CHECK(rms(ofMore, ErrorSource::MoreBounces) > 0.002);
    CHECK(rms(ofMore, ErrorSource::MoreBounces) < 0.3 * rms(ofDirect, ErrorSource::MoreBounces));
    CHECK_THROWS_AS(study(bounced, 1), UsageError);
}

TEST_CASE("verify: bounced rows are those of the twin, and stored beside direct light") {
    const TestDevice device;
    Scene scene = cornerScene();
    BakeOptions options = bounceOptions(2);
    options.layout = {.layout = TransportLayout::Rows};
    options.coefficients = 384;
    const Asset asset = bake(device, std::move(scene), options);
    Environment white{8, 4, std::vector<vec3>(32, vec3(1))};
    const Verification found = verify(device, asset, prepareForSampling(white), 0, 24);
    CHECK(found.bounceError > 0);
    CHECK(found.bounceError < 0.15);
    CHECK(found.transportError < 1e-4);
    CHECK(found.layoutError < 0.1);
    CHECK(found.relightBits == 0);
}
