// Advice on a bake holds once it is baked.
#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "precompute/bake/bake.h"
#include "precompute/error/advice.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

Scene knot() {
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(2500), "red-plastic", "built-in knot", ""});
    return scene;
}

BakeOptions adviceOptions() {
    BakeOptions options;
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.mapSize = 24;
    return options;
}

StudiedLight sky() {
    const auto map = std::make_shared<const Environment>(prepareForSampling(makeSky()));
    const Light light{.environments = {{map}}};
    return {light, sampleLight(light, kTruthFaceSize), {}};
}

// Of the bake's images, from two of the sides that advise() looks from.
double errorOf(const vk::Device& device, const Asset& asset, const StudiedLight& light) {
    double squares = 0;
    for (const float azimuth : {30.0f, 210.0f}) {
        const Camera camera = orbitCamera(objectBounds(asset), glm::radians(azimuth), glm::radians(15.0f), 1,
                                          glm::radians(35.0f), 4.0f / 3);
        const ErrorStudies studies =
            studyErrors(device, asset, defaultAppearance(asset), std::span(&light, 1),
                        {.view = {camera, 16, 12}, .mostPasses = 32});
        squares += std::pow(studies.lights[0].budget.total, 2);
    }
    return std::sqrt(squares / 2);
}

} // namespace

TEST_CASE("advise: a bake of its options has about the error and the bytes that it says") {
    const TestDevice device;
    const StudiedLight light = sky();
    BakeObserver observer;
    constexpr double kWanted = 0.06;
    const Advice advice = advise(device, {knot(), {}, kWanted, adviceOptions(), 60}, light, observer);
    CHECK(!advice.refined);
    CHECK(advice.best() == &*advice.plain.bases);
    for (const auto& advised : {advice.plain.bases, advice.plain.rows}) {
        REQUIRE(advised);
        CHECK(advised->error == doctest::Approx(kWanted).epsilon(0.02));
        const Asset asset = bake(device, knot(), advised->options);
        CHECK(errorOf(device, asset, light) == doctest::Approx(kWanted).epsilon(0.3));
        CHECK(double(bytesOf(asset.parts[0].sets[0].transport)) ==
              doctest::Approx(advised->bytes).epsilon(0.3));
    }
    for (size_t terms = 1; terms < advice.plain.leastErrors.size(); terms++)
        CHECK(advice.plain.leastErrors[terms] < 1.3 * advice.plain.leastErrors[terms - 1]);
    CHECK(advice.plain.leastErrors.back() < 0.7 * advice.plain.leastErrors.front());
}

TEST_CASE("advise: a refined ground is preferred where it needs fewer bytes") {
    const TestDevice device;
    const auto onGround = [](int quads) {
        Scene scene;
        scene.parts.push_back({"ball", makeSphere(2), "clay", "built-in sphere", ""});
        addGround(scene, {.tessellation = quads}, "white-diffuse");
        return scene;
    };
    BakeObserver observer;
    const Advice advice =
        advise(device, {onGround(40), onGround(8), 0.1, adviceOptions(), 40}, sky(), observer);
    REQUIRE(advice.refined);
    CHECK(advice.refined->vertices < advice.plain.vertices / 2);
    REQUIRE(advice.best());
    CHECK(&advice.bestMesh() == &*advice.refined);
    REQUIRE(advice.best()->options.refinement);
    CHECK(advice.best()->options.refinement->wanted == doctest::Approx(0.05));
}

TEST_CASE("advise: what is out of reach is not advised") {
    const TestDevice device;
    BakeObserver observer;
    AdviceRequest request{knot(), {}, 1e-3, adviceOptions(), 40};
    const Advice advice = advise(device, request, sky(), observer);
    CHECK(advice.best() == nullptr);
    CHECK(advice.plain.leastErrors.back() > 1e-3);
    // Whose first terms are those of fewer: not nonnegative ones, which are the default.
    CHECK(advice.plain.leastErrors.size() > 8);
}
