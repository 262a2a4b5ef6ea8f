// Devices that lack what others have give the same bakes and pictures by other shaders.
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "engine/transport/asset.h"
#include "precompute/bake/bake.h"
#include "precompute/layout/conversion.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

Asset bakeKnot(const vk::Device& device, VisibilityMethod method) {
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(400), "gold", "built-in knot", ""});
    BakeOptions options;
    options.visibilityMethod = method;
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.layout = {.layout = TransportLayout::Rows};
    options.coefficients = 48;
    options.mapSize = 24;
    return bake(device, std::move(scene), options);
}

std::vector<vec4> pixelsOf(const vk::Device& device, const Asset& asset, int samples) {
    constexpr int kWidth = 64, kHeight = 48;
    LightPass light(device, asset.faceSize);
    light.setLight({.environments = {{std::make_shared<const Environment>(prepareForSampling(makeSky()))}}});
    Relighter relighter(device, asset);
    ViewPass view(device, asset, {.width = kWidth, .height = kHeight, .samples = samples});
    vk::Commands commands(device, "least features test");
    commands.begin();
    light.record(commands);
    relighter.record(commands, light);
    view.record(commands, defaultCamera(boundsOf(asset), 0.6f, float(kWidth) / float(kHeight)), relighter);
    commands.submitAndWait();
    return view.read().pixels;
}

// Returns the largest difference of any channel, relative to the largest value.
float mostApart(const std::vector<vec4>& found, const std::vector<vec4>& expected) {
    float largest = 0, apart = 0;
    for (size_t i = 0; i < expected.size(); i++)
        for (int c = 0; c < 4; c++) {
            largest = std::max(largest, expected[i][c]);
            apart = std::max(apart, std::abs(found[i][c] - expected[i][c]));
        }
    return apart / largest;
}

} // namespace

TEST_CASE("image: a device of the least features bakes, relights and draws the same") {
    const TestDevice usual, least(true);
    REQUIRE(static_cast<const vk::Device&>(least).info().takesPortableShaders());
    const Asset baked = bakeKnot(usual, VisibilityMethod::Raster);
    // The device draws though it is asked to trace.
    CHECK(encodeAsset(bakeKnot(least, VisibilityMethod::Traced)) == encodeAsset(baked));
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        CAPTURE(layoutName(layout));
        Asset asset = baked;
        if (layout != TransportLayout::Rows)
            convertLayout(asset, {.layout = layout}, [](uint64_t, uint64_t) {});
        for (const int samples : {1, 4}) {
            CAPTURE(samples);
            const std::vector<vec4> found = pixelsOf(least, asset, samples),
                                    expected = pixelsOf(usual, asset, samples);
            if (isSoftware(usual))
                CHECK(found == expected);
            else
                CHECK_LT(mostApart(found, expected), 1e-5f);
        }
    }
}
