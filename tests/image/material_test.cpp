// Materials from files to images: what is drawn against what Embree traces with the exact BRDFs.
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/light/environment.h"
#include "engine/render/compare.h"
#include "engine/render/view_pass.h"
#include "precompute/bake/bake.h"
#include "precompute/reference/reference_image.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_device.h"
#include "tests/support/textured_glb.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;

namespace {

constexpr int kMaterialWidth = 64, kMaterialHeight = 48, kMaterialFaceSize = 32;

class MaterialTest {
  public:
    MaterialTest(Scene scene, int terms, const Camera& camera)
        : mAsset(bake(mDevice, std::move(scene), optionsOf(terms))), mCamera(camera),
          mSky(sampleEnvironment(prepareForSampling(makeSky()), kMaterialFaceSize, 0)),
          mLight(mDevice, kMaterialFaceSize), mRelighter(mDevice, mAsset),
          mView(mDevice, mAsset, {.width = kMaterialWidth, .height = kMaterialHeight, .samples = 1}) {
        mLight.setCube(mSky);
    }

    const Asset& asset() const { return mAsset; }

    Image draw(const Appearance& appearance) {
        vk::Commands commands(mDevice, "material test");
        commands.begin();
        mLight.record(commands, 0, {64});
        mRelighter.record(commands, mLight, appearance);
        mView.setAppearance(appearance);
        mView.record(commands, mCamera, mRelighter);
        commands.submitAndWait();
        return mView.read();
    }

    double error(const Appearance& appearance, ReferenceBrdf brdf = ReferenceBrdf::Exact) {
        ReferenceOptions options{.width = kMaterialWidth, .height = kMaterialHeight, .samples = 1};
        options.brdf = brdf;
        options.raysPerTexelSide = 1;
        options.appearance = appearance;
        return compareImages(draw(appearance), renderReference(mAsset, mCamera, mSky, options)).relativeRmse;
    }

  private:
    static BakeOptions optionsOf(int terms) {
        BakeOptions options;
        options.factorization.terms = terms;
        options.faceSize = kMaterialFaceSize;
        options.visibilitySize = 64;
        options.coefficients = 192;
        options.mapSize = 24;
        return options;
    }

    TestDevice mDevice;
    Asset mAsset;
    Camera mCamera;
    LightCube mSky;
    LightPass mLight;
    Relighter mRelighter;
    ViewPass mView;
};

Appearance boundTo(const Asset& asset, const std::string& name) {
    Appearance appearance = defaultAppearance(asset);
    bindMaterials(appearance, asset, std::vector<WeightedMaterial>{{name}});
    return appearance;
}

// A sphere alone: nothing but its materials decides the image.
Scene sphereScene(const std::string& material) {
    Scene scene;
    scene.parts.push_back({"sphere", makeSphere(3), material, "", ""});
    return scene;
}

const Camera kBeforeSphere{{0, 1, 3}, {0, 0, 0}, 0.8f};

} // namespace

TEST_CASE("image: a glTF file's two textured materials are its reference") {
    const TemporaryFolder folder;
    const std::string glb = TexturedGlb().bytes();
    folder.write("squares.glb", glb);
    Scene scene;
    scene.parts = loadParts((folder.path() / "squares.glb").string(), UpAxis::Y, std::nullopt);
    REQUIRE(scene.parts.size() == 2);
    MaterialTest test(std::move(scene), 16, {{0.3f, 0.9f, 2.6f}, {0.5f, 0.5f, 0.5f}, 0.7f});
    for (const AssetPart& part : test.asset().parts) {
        CHECK(part.baseColor.has_value());
        CHECK(part.sets[0].materials[0].hasBase);
        CHECK(nlohmann::json::parse(part.sets[0].materials[0].description)["model"] == "gltf");
    }
    const double error = test.error(defaultAppearance(test.asset()));
    MESSAGE("textured squares: relative RMSE ", error);
    CHECK_LE(error, 0.06);
}

// A sphere with waves in its normals, lit from all sides.
Scene wavySphere(const std::string& material) {
    Scene scene;
    scene.parts.push_back({"sphere", makeSphere(3, true), material, "", ""});
    Texture waves{64, 64, {}};
    for (int i = 0; i < 64 * 64; i++) {
        const float x = 0.5f * std::sin(2 * kPi * float(i % 64) / 16),
                    y = 0.5f * std::sin(2 * kPi * float(i / 64) / 32);
        const vec3 normal = glm::normalize(vec3(x, y, 1)) * 0.5f + 0.5f;
        waves.texels.push_back(glm::packUnorm4x8(vec4(normal, 1)));
    }
    scene.parts[0].detail.normalMap = std::move(waves);
    return scene;
}

TEST_CASE("image: normal maps are drawn as the reference and its estimate have them") {
    for (const std::string material : {"red-plastic", "gold"}) {
        MaterialTest test(wavySphere(material), 8, kBeforeSphere);
        const Appearance appearance = defaultAppearance(test.asset());
        const double error = test.error(appearance),
                     ofEstimate = test.error(appearance, ReferenceBrdf::Residual);
        MaterialTest plain(sphereScene(material), 8, kBeforeSphere);
        const double without = compareImages(plain.draw(appearance), test.draw(appearance)).relativeRmse;
        MESSAGE(material, ": normal-mapped sphere: relative RMSE ", error, ", of the estimate ", ofEstimate,
                ", without its map ", without);
        CHECK_LE(error, 0.2);
        CHECK_LE(ofEstimate, 0.06);
        CHECK_GE(without, 3 * ofEstimate);
    }
}

TEST_CASE("image: emission is added, and vertex colors tint") {
    Scene scene = sphereScene("white-diffuse");
    scene.parts[0].detail.emission = {0.5f, 0, 2};
    MaterialTest emitting(std::move(scene), 1, kBeforeSphere);
    MaterialTest plain(sphereScene("white-diffuse"), 1, kBeforeSphere);
    const Appearance appearance = defaultAppearance(plain.asset());
    const Image lit = emitting.draw(appearance), without = plain.draw(appearance);
    double largest = 0;
    for (size_t i = 0; i < lit.pixels.size(); i++) {
        const vec4 expected = without.pixels[i] + without.pixels[i].w * vec4(0.5f, 0, 2, 0);
        largest = std::max(largest, double(glm::distance(lit.pixels[i], expected)));
    }
    CHECK(largest < 1e-4);
    CHECK_LE(emitting.error(appearance), 0.06);

    Scene colored = sphereScene("white-diffuse");
    colored.parts[0].mesh.colors.assign(colored.parts[0].mesh.vertexCount(), vec4(0.5f, 0.25f, 1, 1));
    colored.parts[0].tintedByColors = true;
    MaterialTest tinted(std::move(colored), 1, kBeforeSphere);
    CHECK_LE(tinted.error(appearance), 0.06);
    const Image image = tinted.draw(appearance);
    for (size_t i = 0; i < image.pixels.size(); i++) {
        const vec3 expected = vec3(without.pixels[i]) * vec3(0.5f, 0.25f, 1);
        CHECK(glm::distance(vec3(image.pixels[i]), expected) <= 0.02f * glm::length(expected) + 1e-4f);
    }
}

TEST_CASE("image: every material of a set, and a blend, is its reference") {
    MaterialTest test(sphereScene(R"({"set": ["clay", "gold", "red-plastic"]})"), 16, kBeforeSphere);
    REQUIRE(test.asset().parts[0].sets.size() == 1);
    std::vector<Image> images;
    for (const std::string name : {"clay", "gold", "red-plastic"}) {
        const double error = test.error(boundTo(test.asset(), name));
        MESSAGE(name, " in a set of three: relative RMSE ", error);
        CHECK_LE(error, 0.16);
        images.push_back(test.draw(boundTo(test.asset(), name)));
    }
    CHECK_GT(compareImages(images[0], images[1]).relativeRmse, 0.2);
    CHECK_GT(compareImages(images[0], images[2]).relativeRmse, 0.2);
    Appearance blend = defaultAppearance(test.asset());
    bindMaterials(blend, test.asset(), std::vector<WeightedMaterial>{{"clay", 0.5f}, {"gold", 0.5f}});
    CHECK_LE(test.error(blend), 0.16);
}

TEST_CASE("image: materials baked separately are swapped without reloading") {
    MaterialTest test(sphereScene(R"({"separate": ["clay", "red-plastic"]})"), 8, kBeforeSphere);
    REQUIRE(test.asset().parts[0].sets.size() == 2);
    for (const std::string name : {"red-plastic", "clay"}) {
        const double error = test.error(boundTo(test.asset(), name));
        MESSAGE(name, " on its own: relative RMSE ", error);
        CHECK_LE(error, 0.12);
    }
}
