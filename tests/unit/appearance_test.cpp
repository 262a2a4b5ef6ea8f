// Tests binding of materials to parts: names, blends, paint.
#include "engine/base/error.h"
#include "engine/render/appearance.h"
#include "tests/support/asset_sample.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

// Part 0: a set of "matt" (layer 0) and "glossy" (1, and its base 2), and one of "other"; part 1: "matt".
Appearance bound(const Asset& asset, const std::vector<WeightedMaterial>& blend) {
    Appearance appearance = defaultAppearance(asset);
    bindMaterials(appearance, asset, blend);
    return appearance;
}

} // namespace

TEST_CASE("appearance: parts begin as they were baked to be") {
    const Asset asset = sampleAsset();
    const Appearance appearance = defaultAppearance(asset);
    REQUIRE(appearance.size() == 2);
    CHECK(appearance[0].painted); // by its material map
    CHECK(appearance[1].painted); // by its colors
    CHECK(appearance[0].weights == std::vector<float>{1, 0});
    CHECK(materialNames(asset) == std::vector<std::string>{"matt", "glossy", "other"});
}

TEST_CASE("appearance: a material is bound wherever a part has it, and nowhere else") {
    const Asset asset = sampleAsset();
    const Appearance matt = bound(asset, {{"matt"}});
    CHECK(matt[0].set == 0);
    CHECK_FALSE(matt[0].painted);
    CHECK_FALSE(matt[1].painted);
    const Appearance other = bound(asset, {{"other"}});
    CHECK(other[0].set == 1);
    CHECK(other[0].weights == std::vector<float>{1});
    CHECK(other[1].painted); // as before
}

TEST_CASE("appearance: blends need materials of one set, and names that exist") {
    const Asset asset = sampleAsset();
    const Appearance blend = bound(asset, {{"matt", 0.25f}, {"glossy", 0.5f}});
    CHECK(blend[0].weights == std::vector<float>{0.25f / 0.75f, 0.5f / 0.75f}); // over their sum
    CHECK(blend[1].weights == std::vector<float>{1});                           // the one that it has
    CHECK_THROWS_WITH_AS(bound(asset, {{"matt", 0.5f}, {"other", 0.5f}}),
                         doctest::Contains("\"other\" is in no set with the others"), UsageError);
    CHECK_THROWS_WITH_AS(bound(asset, {{"glosy"}}), doctest::Contains("did you mean \"glossy\""), UsageError);
}

TEST_CASE("appearance: bound layers are those of the bound materials, bases textured, paint by channel") {
    const Asset asset = sampleAsset();
    const auto layers = boundLayers(asset.parts[0], bound(asset, {{"matt", 0}, {"glossy", 0.5f}})[0]);
    REQUIRE(layers.size() == 2);
    CHECK(layers[0].layer == 1);
    CHECK_FALSE(layers[0].textured);
    CHECK(layers[1].layer == 2);
    CHECK(layers[1].textured);
    CHECK(layers[1].weight == 1); // over the sum of what is there
    CHECK(layers[1].channel == -1);
    const auto painted = boundLayers(asset.parts[0], defaultAppearance(asset)[0]);
    REQUIRE(painted.size() == 3);
    CHECK(painted[0].channel == 0);
    CHECK(painted[2].channel == 1);
    CHECK(painted[2].weight == 1);
}

TEST_CASE("appearance: paint is shared by the materials there are") {
    CHECK(paintWeights({0.5f, 0.5f, 1, 1}, 2) == vec4(0.5f, 0.5f, 0, 0));
    CHECK(paintWeights({0, 0, 0, 0.5f}, 4) == vec4(0, 0, 0, 1));
    CHECK(paintWeights({0, 0, 1, 1}, 2) == vec4(1, 0, 0, 0)); // none of theirs: the first alone
}
