// A BRDF as a matrix: its directions, its entries, its symmetry.
#include "engine/base/error.h"
#include "precompute/brdf/tabulation.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;

namespace {

// f depends on the incoming direction only: as far from reciprocal as can be.
class OneSided final : public Brdf {
  public:
    vec3 evaluate(vec3 incoming, vec3) const override { return vec3(incoming.z); }
    bool isReciprocal() const override { return false; }
    nlohmann::json describe() const override { return {{"model", "one-sided"}}; }
};

} // namespace

TEST_CASE("tabulation: the directions are the texel centres inside the map's domain") {
    const auto brdf = makeBrdf("grey-diffuse");
    CHECK(tabulate(*brdf, 48, DiskMapping::Orthographic).directions.size() == 1804);
    CHECK(tabulate(*brdf, 16, DiskMapping::Polar).directions.size() == 256);
    for (DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::Polar}) {
        const BrdfTable table = tabulate(*brdf, 16, mapping);
        for (size_t i = 0; i < table.directions.size(); i++) {
            CHECK(table.directions[i].z > 0);
            CHECK(glm::length(table.directions[i]) == doctest::Approx(1).epsilon(1e-5));
            const vec2 centre = (vec2(table.texels[i]) + 0.5f) / 16.0f;
            CHECK(glm::length(diskMapCoordinates(mapping, table.directions[i]) - centre) < 1e-4f);
        }
    }
}

TEST_CASE("tabulation: entries are the BRDF, rows incoming and columns outgoing, channel by channel") {
    const auto brdf = makeBrdf("skin");
    const BrdfTable table = tabulate(*brdf, 12, DiskMapping::Orthographic);
    const int n = int(table.directions.size());
    for (int i = 0; i < n; i += 7)
        for (int o = 0; o < n; o += 5) {
            const vec3 value = brdf->evaluate(table.directions[size_t(i)], table.directions[size_t(o)]);
            for (int c = 0; c < 3; c++) CHECK(table.channels[size_t(c)](i, o) == value[c]);
        }
    const BrdfTable oneSided = tabulate(OneSided(), 12, DiskMapping::Orthographic);
    CHECK(oneSided.channels[0](3, 20) == oneSided.directions[3].z);
}

TEST_CASE("tabulation: asymmetry is rounding for reciprocal models, and detected otherwise") {
    for (const MaterialPreset& preset : materialPresets())
        CHECK(tabulate(*makeBrdf(preset.name), 12, DiskMapping::Orthographic).asymmetry < 1e-5f);
    CHECK(tabulate(OneSided(), 12, DiskMapping::Orthographic).asymmetry > 0.1f);
    const auto black = makeBrdf(R"({"model": "diffuse", "albedo": 0})");
    CHECK(tabulate(*black, 12, DiskMapping::Orthographic).asymmetry == 0);
}

TEST_CASE("tabulation: sizes out of range are refused") {
    for (int size : {-1, 0, 3, 65, 1 << 30})
        CHECK_THROWS_AS(tabulate(*makeBrdf("clay"), size, DiskMapping::Polar), UsageError);
}
