// Relit images against Embree references of the same view and light; what remains is explained.
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/render/compare.h"
#include "engine/render/relighter.h"
#include "engine/render/view_pass.h"
#include "precompute/bake/bake.h"
#include "precompute/bake/bake_options.h"
#include "precompute/reference/reference_image.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

constexpr int kRenderWidth = 80, kRenderHeight = 60, kRenderFaceSize = 32;
constexpr int kAllCoefficients = 6 * kRenderFaceSize * kRenderFaceSize;

Asset bakeKnot(const vk::Device& device, const std::string& material, BakeOptions options) {
    options.faceSize = kRenderFaceSize;
    options.visibilitySize = 128;
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(3000), material, "built-in knot", ""});
    return bake(device, std::move(scene), options);
}

Asset bakeDiffuseKnot(const vk::Device& device, int coefficients) {
    BakeOptions options;
    options.coefficients = coefficients;
    return bakeKnot(device, "gray-diffuse", options);
}

Camera viewOf(const Asset& asset) {
    return defaultCamera(boundsOf(asset), 0.6f, float(kRenderWidth) / float(kRenderHeight));
}

Image relit(const vk::Device& device, const Asset& asset, const LightCube& cube, int threshold, int samples) {
    LightPass light(device, asset.faceSize);
    light.setCube(cube);
    Relighter relighter(device, asset, {.residual = false}); // what the reference draws, too
    ViewPass view(device, asset, {.width = kRenderWidth, .height = kRenderHeight, .samples = samples});
    vk::Commands commands(device, "render test");
    commands.begin();
    light.record(commands, 0, {threshold});
    relighter.record(commands, light);
    view.record(commands, viewOf(asset), relighter);
    commands.submitAndWait();
    return view.read();
}

double relativeRmse(const vk::Device& device, const Asset& asset, const LightCube& cube, ReferenceBrdf brdf,
                    int threshold, int raysPerTexelSide = 1) {
    ReferenceOptions options;
    options.width = kRenderWidth;
    options.height = kRenderHeight;
    options.samples = 1;
    options.raysPerTexelSide = raysPerTexelSide;
    options.brdf = brdf;
    const double error = compareImages(relit(device, asset, cube, threshold, 1),
                                       renderReference(asset, viewOf(asset), cube, options))
                             .relativeRmse;
    MESSAGE(asset.parts[0].sets[0].materials[0].name, ", N = ", asset.coefficients, ", threshold ", threshold,
            ": relative RMSE ", error);
    return error;
}

} // namespace

TEST_CASE("image: a diffuse knot under the sky is its reference") {
    const TestDevice device;
    const LightCube sky = sampleEnvironment(prepareForSampling(makeSky()), kRenderFaceSize, 0);
    // What remains at all coefficients is interpolation between vertices and facets against smooth normals.
    CHECK_LE(relativeRmse(device, bakeDiffuseKnot(device, kAllCoefficients), sky, ReferenceBrdf::Exact, 0, 2),
             0.015 + silhouetteError(device));
    CHECK_LE(
        relativeRmse(device, bakeDiffuseKnot(device, 96), sky, ReferenceBrdf::Exact, kPaperLightThreshold),
        0.05 + silhouetteError(device));
}

TEST_CASE("image: edges are as the reference has them") {
    const TestDevice device;
    const LightCube sky = sampleEnvironment(prepareForSampling(makeSky()), kRenderFaceSize, 0);
    const Asset asset = bakeDiffuseKnot(device, kAllCoefficients);
    const Image image = relit(device, asset, sky, 0, kDefaultSamples);
    for (const int samples : {1, kDefaultSamples}) {
        const Image reference = renderReference(
            asset, viewOf(asset), sky,
            {.width = kRenderWidth, .height = kRenderHeight, .samples = samples, .raysPerTexelSide = 1});
        int edges = 0, differ = 0;
        double squares = 0, level = 0;
        for (size_t i = 0; i < image.pixels.size(); i++) {
            const vec4 a = image.pixels[i], b = reference.pixels[i];
            if (a.w == 0 || a.w == 1) continue;
            edges++;
            differ += a.w != b.w;
            squares += double(glm::dot(vec3(a - b), vec3(a - b)));
            level += double(glm::dot(vec3(b), vec3(b)));
        }
        MESSAGE(edges, " pixels are covered in part; ", differ, " in another part in a reference of ",
                samples, " samples, relative RMSE ", std::sqrt(squares / level));
        CHECK_GT(edges, 100);
        const double rounding = silhouetteError(device); // decides a few pixels
        CHECK((differ < (0.02 + rounding) * edges) == (samples > 1));
        CHECK((std::sqrt(squares / level) < 0.1 + rounding) == (samples > 1));
    }
}

TEST_CASE("image: a glossy knot baked the paper's way is the reference of its factors") {
    const TestDevice device;
    const LightCube sky = sampleEnvironment(prepareForSampling(makeSky()), kRenderFaceSize, 0);
    CHECK_LE(relativeRmse(device, bakeKnot(device, "ashikhmin-shirley", presetOptions(BakePreset::Paper)),
                          sky, ReferenceBrdf::Factored, kPaperLightThreshold),
             0.08 + silhouetteError(device));
}

TEST_CASE("image: under an even light a convex diffuse object shows its albedo") {
    const TestDevice device;
    Scene scene;
    scene.parts.push_back({"sphere", makeSphere(3), R"({"model": "diffuse", "albedo": 0.5})", "", ""});
    const Asset asset = bake(device, std::move(scene), {});
    const LightCube even{64, std::vector<vec3>(6 * 64 * 64, vec3(1))};
    const Image image = relit(device, asset, even, 0, kDefaultSamples);
    int covered = 0;
    for (const vec4& pixel : image.pixels) {
        if (pixel.w == 0) continue;
        covered++;
        CHECK(pixel.x / pixel.w == doctest::Approx(0.5).epsilon(0.01));
        CHECK(pixel.z / pixel.w == doctest::Approx(0.5).epsilon(0.01));
    }
    CHECK_GT(covered, kRenderWidth * kRenderHeight / 6);
}
