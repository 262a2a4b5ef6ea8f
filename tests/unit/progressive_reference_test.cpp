// Tests the sampled reference against the exact one, and its estimate of its own noise.
#include "precompute/reference/progressive_reference.h"

#include "engine/import/builtin_mesh.h"
#include "engine/math/cubemap.h"
#include "precompute/reference/reference_image.h"
#include "tests/support/diffuse_asset.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <tbb/global_control.h>
#include <thread>

using namespace relume;
using namespace relume::test;

namespace {

constexpr int kWidth = 32, kHeight = 24, kLightFace = 8;
const Camera kCamera{{0.5f, 2.5f, 3.2f}, vec3(0), 0.6f};

// A torus above a ground, both in this material.
Asset makeScene(const std::string& material) {
    Mesh ground = makePlane(4, 4);
    for (vec3& position : ground.positions) position.y -= 0.5f;
    Asset asset =
        makeTestAsset({makeDiffusePart(makeTorus(1, 0.4f, 48, 24), 0.5f), makeDiffusePart(ground, 0.5f)});
    for (AssetPart& part : asset.parts) part.sets[0].materials[0].description = material;
    return asset;
}
const std::string kDiffuse = R"({"model": "diffuse", "albedo": [0.8, 0.5, 0.3]})";
const std::string kGlossy = R"({"model": "plastic", "diffuse": 0.2, "roughness": 0.25})";

// A colored sky, and a sun of one texel that gives half of the light.
LightCube makeSunnySky() {
    LightCube light{kLightFace, {}};
    for (int i = 0; i < 6 * kLightFace * kLightFace; i++) {
        const vec3 d = cubeTexelDirection(i / (kLightFace * kLightFace), i % kLightFace,
                                          i / kLightFace % kLightFace, kLightFace);
        light.radiance.push_back(d.y > 0 ? vec3(0.5f, 0.7f, 1) * (1.2f + d.x) : vec3(0.2f, 0.15f, 0.1f));
    }
    light.radiance[size_t(cubeTexelIndex(2, 6, 4, kLightFace))] = vec3(120, 100, 80);
    return light;
}

// Nothing but one texel.
LightCube makeLamp() {
    LightCube light{kLightFace, std::vector<vec3>(6 * kLightFace * kLightFace, vec3(0))};
    light.radiance[size_t(cubeTexelIndex(4, 3, 1, kLightFace))] = vec3(50, 60, 70);
    return light;
}

Image truthOf(const Asset& asset, const LightCube& light, int raysPerTexelSide, int samples = 1) {
    return renderReference(
        asset, kCamera, light,
        {.width = kWidth, .height = kHeight, .samples = samples, .raysPerTexelSide = raysPerTexelSide});
}

void start(ProgressiveReference& reference, const Asset& asset, const LightCube& light, int samples = 1) {
    reference.restart(kCamera, light, defaultAppearance(asset), kWidth, kHeight, samples);
}

void addPasses(ProgressiveReference& reference, int passes) {
    for (int i = 0; i < passes; i++) REQUIRE(reference.addPass());
}

// Over pixels that `truth` covers.
double rmse(const Image& image, const Image& truth) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < truth.pixels.size(); i++) {
        CHECK(image.pixels[i].w == truth.pixels[i].w);
        if (truth.pixels[i].w == 0) continue;
        const vec3 difference(image.pixels[i] - truth.pixels[i]);
        sum += double(glm::dot(difference, difference)), count += 3;
    }
    return std::sqrt(sum / count);
}

} // namespace

TEST_CASE("progressive reference: converges to the exact one, as fast as it says") {
    for (const std::string& material : {kDiffuse, kGlossy})
        for (bool isLamp : {false, true}) {
            CAPTURE(material);
            CAPTURE(isLamp);
            const Asset asset = makeScene(material);
            const LightCube light = isLamp ? makeLamp() : makeSunnySky();
            const Image truth = truthOf(asset, light, isLamp ? 16 : 6); // one texel's shadow is sharper
            ProgressiveReference reference(asset);
            start(reference, asset, light);
            double firstNoise = 0;
            for (int passes : {16, 240}) {
                addPasses(reference, passes);
                const ReferenceError error = *reference.errorOf(truth);
                const double found = rmse(reference.mean(), truth);
                CHECK(error.noise < (passes == 16 ? 0.15 : 0.03) * error.level);
                CHECK(found < 1.2 * error.noise);
                CHECK(found > 0.8 * error.noise);
                CHECK(error.rmse < 0.5 * error.noise);
                if (passes == 16)
                    firstNoise = error.noise;
                else
                    CHECK(error.noise == doctest::Approx(firstNoise / 4).epsilon(0.2));
            }
        }
}

TEST_CASE("progressive reference: pixels of several samples converge to those of the exact one") {
    const Asset asset = makeScene(kDiffuse);
    const LightCube light = makeSunnySky();
    const Image truth = truthOf(asset, light, 6, 4);
    CHECK(std::ranges::count_if(truth.pixels, [](const vec4& pixel) { return pixel.w > 0 && pixel.w < 1; }) >
          20);
    ProgressiveReference reference(asset);
    start(reference, asset, light, 4);
    addPasses(reference, 256);
    const ReferenceError error = *reference.errorOf(truth);
    const double found = rmse(reference.mean(), truth); // and alpha is the same
    CHECK(found < 0.04 * error.level);
    CHECK(found < 1.3 * error.noise);
    CHECK(error.rmse < 0.6 * error.noise);
    // Centers alone are another image.
    start(reference, asset, light);
    addPasses(reference, 256);
    CHECK(reference.errorOf(truth)->rmse > 3 * error.noise);
}

TEST_CASE("progressive reference: a ground fades or shows its shadow as in the exact one") {
    Asset asset = makeScene(kDiffuse);
    asset.parts[1].name = "ground";
    const LightCube light = makeSunnySky();
    for (const GroundStyle style : {GroundStyle::Fade, GroundStyle::Shadow}) {
        CAPTURE(kGroundStyleNames[size_t(style)]);
        const auto ground = makeGroundFade(asset, style);
        REQUIRE(ground);
        const Image truth = renderReference(
            asset, kCamera, light,
            {.width = kWidth, .height = kHeight, .raysPerTexelSide = 6, .groundFade = ground});
        CHECK(std::ranges::count_if(truth.pixels,
                                    [](vec4 pixel) { return pixel.w > 0.1f && pixel.w < 0.9f; }) > 50);
        ProgressiveReference reference(asset);
        reference.restart(kCamera, light, defaultAppearance(asset), kWidth, kHeight, kDefaultSamples, ground);
        addPasses(reference, 256);
        const Image mean = reference.mean();
        double alphas = 0, radiances = 0, level = 0;
        for (size_t i = 0; i < truth.pixels.size(); i++) {
            const vec4 found = mean.pixels[i], expected = truth.pixels[i];
            alphas += double((found.w - expected.w) * (found.w - expected.w));
            const vec3 difference(found - expected);
            radiances += double(glm::dot(difference, difference));
            level += double(glm::dot(vec3(expected), vec3(expected)));
        }
        CHECK(std::sqrt(alphas / double(truth.pixels.size())) < 0.015);
        CHECK(std::sqrt(radiances / level) < 0.05);
    }
}

TEST_CASE("progressive reference: an image's error is told without the reference's own noise") {
    const Asset asset = makeScene(kDiffuse);
    const LightCube light = makeSunnySky();
    const Image truth = truthOf(asset, light, 6);
    // Wrong where it is bright, and by a constant.
    Image brighter = truth, shifted = truth;
    for (vec4& pixel : brighter.pixels) pixel *= vec4(1.1f, 1.1f, 1.1f, 1);
    for (vec4& pixel : shifted.pixels) pixel += vec4(0.1f, -0.1f, 0.1f, 0);
    ProgressiveReference reference(asset);
    start(reference, asset, light);
    addPasses(reference, 1);
    CHECK_FALSE(reference.errorOf(truth));
    addPasses(reference, 1);
    // Within a standard deviation of it or two; the difference from the mean is dominated by noise.
    const ReferenceError early = *reference.errorOf(brighter);
    CHECK(rmse(reference.mean(), brighter) > 1.3 * rmse(truth, brighter));
    CHECK(early.rmse == doctest::Approx(rmse(truth, brighter)).epsilon(0.15));
    CHECK(early.level == doctest::Approx(10 * rmse(truth, brighter)).epsilon(0.05));
    addPasses(reference, 61);
    CHECK(reference.errorOf(brighter)->rmse == doctest::Approx(rmse(truth, brighter)).epsilon(0.02));
    CHECK(reference.errorOf(shifted)->rmse == doctest::Approx(0.1).epsilon(0.02));
    // As many passes more or less in one half make no difference to what is said of noise.
    const double odd = reference.errorOf(truth)->noise;
    addPasses(reference, 1);
    CHECK(reference.errorOf(truth)->noise == doctest::Approx(odd).epsilon(0.03));
    CHECK(reference.errorOf(truth)->noise == doctest::Approx(rmse(reference.mean(), truth)).epsilon(0.1));
}

TEST_CASE("progressive reference: squared errors scatter as their standard error says") {
    const Asset asset = makeScene(kDiffuse);
    const LightCube light = makeSunnySky();
    Image gray(kWidth, kHeight);
    for (vec4& pixel : gray.pixels) pixel = vec4(0.3f, 0.3f, 0.3f, 1);
    ProgressiveReference reference(asset);
    constexpr int kViews = 16;
    double scatter = 0; // squared, in standard errors
    for (int view = 0; view < kViews; view++) {
        Camera camera = kCamera;
        camera.eye.x += 0.05f * float(view);
        reference.restart(camera, light, defaultAppearance(asset), kWidth, kHeight, 1);
        addPasses(reference, 4);
        const ReferenceError early = *reference.errorOf(gray);
        addPasses(reference, 252);
        const ReferenceError late = *reference.errorOf(gray);
        CHECK(late.rmse * late.rmse == doctest::Approx(late.square));
        CHECK(late.squareNoise < 0.2 * early.squareNoise);
        const double off = (early.square - late.square) / early.squareNoise;
        scatter += off * off / kViews;
    }
    CHECK(scatter > 0.3);
    CHECK(scatter < 2.5);
}

TEST_CASE("progressive reference: mean squared errors of many halves come to the true one") {
    const Asset asset = makeScene(kGlossy);
    const LightCube light = makeSunnySky();
    const Image truth = truthOf(asset, light, 6);
    ProgressiveReference reference(asset);
    start(reference, asset, light);
    // Of pairs of single passes, from how sums change.
    double estimates = 0, naive = 0;
    constexpr int kPairs = 50;
    for (int pair = 0; pair < kPairs; pair++) {
        std::array<Image, 2> halves;
        for (Image& half : halves) {
            const Image before = reference.mean();
            addPasses(reference, 1);
            half = reference.mean();
            const auto n = float(reference.passes());
            for (size_t i = 0; i < half.pixels.size(); i++)
                half.pixels[i] = n * half.pixels[i] - (n - 1) * before.pixels[i];
        }
        for (size_t i = 0; i < truth.pixels.size(); i++) {
            const vec3 a(halves[0].pixels[i] - truth.pixels[i]), b(halves[1].pixels[i] - truth.pixels[i]);
            estimates += double(glm::dot(a, b));
            naive += double(glm::dot(a, a));
        }
    }
    CHECK(std::abs(estimates) < 0.01 * naive);
}

TEST_CASE("progressive reference: a pass depends on its number alone") {
    const Asset asset = makeScene(kGlossy);
    ProgressiveReference reference(asset);
    start(reference, asset, makeSunnySky());
    CHECK(reference.mean().pixels == Image(kWidth, kHeight).pixels);
    addPasses(reference, 1);
    const Image first = reference.mean();
    addPasses(reference, 2);
    const Image third = reference.mean();
    CHECK(third.pixels != first.pixels);
    CHECK(reference.passes() == 3);

    const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
    for (bool isNew : {false, true}) {
        ProgressiveReference other(asset);
        ProgressiveReference& again = isNew ? other : reference;
        start(again, asset, makeSunnySky());
        CHECK(again.passes() == 0);
        addPasses(again, 1);
        CHECK(again.mean().pixels == first.pixels);
        addPasses(again, 2);
        CHECK(again.mean().pixels == third.pixels);
    }
}

TEST_CASE("progressive reference: a restart takes nothing over") {
    const Asset asset = makeScene(kGlossy);
    ProgressiveReference reference(asset);
    start(reference, asset, makeSunnySky());
    addPasses(reference, 1);
    const Camera other{{3, 1, 0}, vec3(0, 0.1f, 0), 0.5f};
    Appearance half = defaultAppearance(asset);
    half[0].weights = {0.5f};
    const auto check = [&](const Camera& camera, const LightCube& light, const Appearance& appearance,
                           int width, int height, int samples = 1) {
        ProgressiveReference fresh(asset);
        for (ProgressiveReference* each : {&reference, &fresh}) {
            each->restart(camera, light, appearance, width, height, samples);
            addPasses(*each, 2);
        }
        CHECK(reference.mean().pixels == fresh.mean().pixels);
    };
    check(kCamera, makeLamp(), defaultAppearance(asset), kWidth, kHeight);
    check(other, makeLamp(), defaultAppearance(asset), kWidth, kHeight);
    check(other, makeLamp(), half, kWidth, kHeight);
    check(other, makeLamp(), half, kWidth, kHeight, 4);
    check(other, makeLamp(), half, kWidth, kHeight, 2);
    check(other, makeLamp(), half, kHeight, kWidth);
    check(other, makeLamp(), half, 7, 5);
    check({{0, 9, 0}, {0, 10, 0}, 0.5f}, makeLamp(), half, 7, 5); // sees nothing
    CHECK_FALSE(reference.errorOf(Image(7, 5)));
    check(kCamera, {kLightFace, std::vector<vec3>(6 * kLightFace * kLightFace, vec3(0))}, half, 7, 5);
    CHECK(reference.mean().at(3, 2) == vec4(0, 0, 0, 1));
}

TEST_CASE("progressive reference: a stopped pass counts for nothing") {
    const Asset asset = makeScene(kGlossy);
    ProgressiveReference reference(asset), undisturbed(asset);
    for (ProgressiveReference* each : {&reference, &undisturbed}) {
        each->restart(kCamera, makeSunnySky(), defaultAppearance(asset), 256, 192, 4);
        addPasses(*each, 1);
    }
    const auto isUndisturbed = [&] {
        while (undisturbed.passes() < reference.passes()) addPasses(undisturbed, 1);
        return reference.mean().pixels == undisturbed.mean().pixels;
    };
    std::stop_source stopped;
    stopped.request_stop();
    CHECK_FALSE(reference.addPass(stopped.get_token()));
    CHECK(reference.passes() == 1);
    CHECK(isUndisturbed());

    std::stop_source later;
    const std::jthread stopper([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        later.request_stop();
    });
    int passes = 1;
    while (reference.addPass(later.get_token())) passes++;
    CHECK(reference.passes() == passes);
    CHECK(isUndisturbed());
    addPasses(reference, 1);
    CHECK(isUndisturbed());
}

TEST_CASE("progressive reference: factored, it is the factored image, and never negative") {
    Asset asset = makeScene(kDiffuse);
    for (vec3& value : asset.parts[0].sets[0].brdf.viewMaps) value = vec3(-1, 1, 0);
    const LightCube light = makeSunnySky();
    const Image truth = renderReference(asset, kCamera, light,
                                        {.width = kWidth,
                                         .height = kHeight,
                                         .samples = 1,
                                         .brdf = ReferenceBrdf::Factored,
                                         .raysPerTexelSide = 6});
    ProgressiveReference reference(asset, ReferenceBrdf::Factored);
    start(reference, asset, light);
    addPasses(reference, 64);
    const Image found = reference.mean();
    CHECK(rmse(found, truth) < 1.2 * reference.errorOf(truth)->noise);
    for (const vec4& pixel : found.pixels) CHECK(pixel.x >= 0);
}
