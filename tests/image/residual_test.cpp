// What K terms leave of a BRDF, added to images: against the exact reference, and against the reference of
// the same estimate.
#include "engine/render/compare.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "engine/scene/builtin_mesh.h"
#include "engine/scene/scene.h"
#include "precompute/bake/bake.h"
#include "precompute/reference/reference_image.h"
#include "precompute/residual/residuals.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

constexpr int kWidth = 96, kHeight = 72;

Asset bakeKnot(const vk::Device& device, const std::string& material, Factorization method) {
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(2000), material, "built-in knot", ""});
    BakeOptions options;
    options.factorization.terms = 5;
    options.factorization.method = method;
    return bake(device, std::move(scene), options);
}

Camera viewOf(const Asset& asset) {
    return defaultCamera(boundsOf(asset), 0.6f, float(kWidth) / float(kHeight));
}

Image relit(const vk::Device& device, const Asset& asset, const LightCube& cube, const Residuals& residuals,
            bool isAdded = true) {
    LightPass light(device, asset.faceSize);
    light.setCube(cube);
    Relighter relighter(device, asset, {.residuals = residuals});
    ViewPass view(device, asset, {.width = kWidth, .height = kHeight});
    view.setResidual(isAdded);
    vk::Commands commands(device, "residual test");
    commands.begin();
    light.record(commands);
    relighter.record(commands, light);
    view.record(commands, viewOf(asset), relighter);
    commands.submitAndWait();
    return view.read();
}

Image reference(const Asset& asset, const LightCube& cube, ReferenceBrdf brdf) {
    ReferenceOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.raysPerTexelSide = 1;
    options.brdf = brdf;
    return renderReference(asset, viewOf(asset), cube, options);
}

} // namespace

TEST_CASE("image: the residual makes up for what K terms miss") {
    const TestDevice device;
    const LightCube sky = sampleEnvironment(prepareForSampling(makeSky()), 64, 0);
    for (const Factorization method : {Factorization::Environment, Factorization::NonNegative}) {
        const Asset asset = bakeKnot(device, "gold", method);
        const Residuals residuals = makeResiduals(asset);
        REQUIRE(residuals[0][0]);
        CHECK(residuals[0][0]->isPositive == (method == Factorization::NonNegative));
        const Image exact = reference(asset, sky, ReferenceBrdf::Exact);
        const Image drawn = relit(device, asset, sky, residuals), terms = relit(device, asset, sky, {});
        const double error = compareImages(drawn, exact).relativeRmse,
                     ofTerms = compareImages(terms, exact).relativeRmse,
                     ofEstimate =
                         compareImages(drawn, reference(asset, sky, ReferenceBrdf::Residual)).relativeRmse;
        MESSAGE(factorizationName(method), ": terms alone ", ofTerms, ", with the residual ", error,
                ", from the same estimate ", ofEstimate);
        CHECK_LE(error, 0.5 * ofTerms);
        CHECK_LE(ofEstimate, 0.06);
        // Switched off, not a bit of it is left.
        CHECK(relit(device, asset, sky, residuals, false).pixels == terms.pixels);
    }
}

TEST_CASE("image: a diffuse material has no residual, and light that is none gives none") {
    const TestDevice device;
    const Asset diffuse = bakeKnot(device, "grey-diffuse", Factorization::Environment);
    CHECK_FALSE(makeResiduals(diffuse)[0][0]);
    const Asset gold = bakeKnot(device, "gold", Factorization::NonNegative);
    const LightCube dark{64, std::vector<vec3>(6 * 64 * 64, vec3(0))};
    for (const vec4& pixel : relit(device, gold, dark, makeResiduals(gold)).pixels)
        CHECK(vec3(pixel) == vec3(0));
}

TEST_CASE("image: a material whose BRDF is gone is drawn by its terms alone") {
    const TestDevice device;
    Asset asset = bakeKnot(device, "gold", Factorization::Environment);
    asset.parts[0].sets[0].materials[0].description =
        R"({"measured": "/nowhere/gold.binary", "scale": 1, "hash": "0"})";
    CHECK_FALSE(makeResiduals(asset)[0][0]);
}
