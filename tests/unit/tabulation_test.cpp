// Tests tabulation of a BRDF as a matrix: its directions, entries and symmetry.
#include "engine/base/error.h"
#include "precompute/brdf/tabulation.h"

#include <algorithm>
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

// The mean that a table stands for, by 6^4 pairs of places in every pair of texels.
Eigen::MatrixXf bruteForceMeans(const Brdf& brdf, const BrdfTable& table) {
    constexpr int kPlaces = 6;
    const auto placesIn = [&](ivec2 texel) {
        std::vector<vec3> directions;
        for (int i = 0; i < kPlaces * kPlaces; i++) {
            const vec2 place = (vec2(i % kPlaces, i / kPlaces) + 0.5f) / float(kPlaces);
            const auto direction = diskMapDirection(table.mapping, (vec2(texel) + place) / float(table.size));
            if (direction && direction->z > kGrazingCosine) directions.push_back(*direction);
        }
        return directions;
    };
    const auto n = Eigen::Index(table.texels.size());
    return Eigen::MatrixXf::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index o) {
        double sum = 0, weights = 0;
        for (const vec3& incoming : placesIn(table.texels[size_t(i)]))
            for (const vec3& outgoing : placesIn(table.texels[size_t(o)])) {
                const double weight = double(incoming.z) * double(outgoing.z);
                sum += weight * double(brdf.evaluate(incoming, outgoing).x);
                weights += weight;
            }
        return float(sum / weights);
    });
}

} // namespace

TEST_CASE("tabulation: the directions are the texel centers inside the map's domain") {
    const auto brdf = makeBrdf("gray-diffuse");
    CHECK(tabulate(*brdf, 48, DiskMapping::Orthographic).directions.size() == 1804);
    CHECK(tabulate(*brdf, 16, DiskMapping::Polar).directions.size() == 256);
    for (DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar, DiskMapping::Polar}) {
        const BrdfTable table = tabulate(*brdf, 16, mapping);
        for (size_t i = 0; i < table.directions.size(); i++) {
            CHECK(table.directions[i].z > 0);
            CHECK(glm::length(table.directions[i]) == doctest::Approx(1).epsilon(1e-5));
            const vec2 center = (vec2(table.texels[i]) + 0.5f) / 16.0f;
            CHECK(glm::length(diskMapCoordinates(mapping, table.directions[i]) - center) < 1e-4f);
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
            // Evaluated where a turn brings the pair.
            for (int c = 0; c < 3; c++)
                CHECK(table.channels[size_t(c)](i, o) == doctest::Approx(value[c]).epsilon(1e-4));
        }
    const BrdfTable oneSided = tabulate(OneSided(), 12, DiskMapping::Orthographic);
    CHECK(oneSided.channels[0](3, 20) == doctest::Approx(oneSided.directions[3].z));
}

// A reciprocal model that does not say so: every entry is evaluated.
class Discreet final : public Brdf {
  public:
    explicit Discreet(const std::string& material) : mBrdf(makeBrdf(material)) {}
    vec3 evaluate(vec3 incoming, vec3 outgoing) const override { return mBrdf->evaluate(incoming, outgoing); }
    bool isReciprocal() const override { return false; }
    bool isIsotropic() const override { return mBrdf->isIsotropic(); }
    nlohmann::json describe() const override { return mBrdf->describe(); }

  private:
    std::unique_ptr<Brdf> mBrdf;
};

TEST_CASE("tabulation: half a table of a reciprocal model is mirrored, and is what all of it would be") {
    for (const MaterialPreset& preset : materialPresets())
        for (TexelValue value : {TexelValue::Center, TexelValue::Mean}) {
            const BrdfTable half = tabulate(*makeBrdf(preset.name), 12, DiskMapping::EqualArea, value),
                            whole = tabulate(Discreet(preset.name), 12, DiskMapping::EqualArea, value);
            CHECK(half.asymmetry == 0);
            CHECK(whole.asymmetry < 1e-5f);
            CHECK((half.channels[0] - whole.channels[0]).norm() <= 1e-5f * whole.channels[0].norm());
        }
}

// Isotropic and reciprocal, but not the same in a mirror, as measured BRDFs can be.
class Handed final : public Brdf {
  public:
    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        const float turn = incoming.x * outgoing.y - incoming.y * outgoing.x;
        return vec3(1 + 0.5f * turn * (incoming.z - outgoing.z));
    }
    nlohmann::json describe() const override { return {{"model", "handed"}}; }
};

TEST_CASE("tabulation: quarter turns leave an isotropic table as it is, and mirrors need not") {
    for (TexelValue value : {TexelValue::Center, TexelValue::Mean}) {
        const BrdfTable table = tabulate(*makeBrdf("gold"), 12, DiskMapping::EqualArea, value);
        const auto turned = [&](size_t number) {
            const ivec2 texel = table.texels[number];
            return std::ranges::find(table.texels, ivec2(11 - texel.y, texel.x)) - table.texels.begin();
        };
        for (size_t i = 0; i < table.texels.size(); i += 5)
            for (size_t o = 0; o < table.texels.size(); o += 7)
                CHECK(table.channels[0](turned(i), turned(o)) ==
                      table.channels[0](Eigen::Index(i), Eigen::Index(o)));
    }
    const BrdfTable handed = tabulate(Handed(), 12, DiskMapping::EqualArea);
    CHECK(handed.asymmetry < 1e-5f);
    for (size_t i = 0; i < handed.texels.size(); i += 5)
        for (size_t o = 0; o < handed.texels.size(); o += 7) {
            const vec3 own = Handed().evaluate(handed.directions[i], handed.directions[o]);
            CHECK(handed.channels[0](Eigen::Index(i), Eigen::Index(o)) ==
                  doctest::Approx(own.x).epsilon(1e-5));
        }
    const auto brushed = makeBrdf("brushed-steel");
    const BrdfTable table = tabulate(*brushed, 12, DiskMapping::EqualArea);
    for (size_t i = 0; i < table.texels.size(); i += 5) {
        const vec3 value = brushed->evaluate(table.directions[i], table.directions[9]);
        CHECK(table.channels[0](Eigen::Index(i), 9) == doctest::Approx(value.x).epsilon(1e-6));
    }
}

TEST_CASE("tabulation: asymmetry is detected") {
    CHECK(tabulate(OneSided(), 12, DiskMapping::Orthographic).asymmetry > 0.1f);
    const auto black = makeBrdf(R"({"model": "diffuse", "albedo": 0})");
    CHECK(tabulate(*black, 12, DiskMapping::Orthographic).asymmetry == 0);
}

TEST_CASE("tabulation: sizes out of range are refused") {
    for (int size : {-1, 0, 3, 65, 1 << 30})
        CHECK_THROWS_AS(tabulate(*makeBrdf("clay"), size, DiskMapping::Polar), UsageError);
}

TEST_CASE("tabulation: means keep a reciprocal BRDF symmetric, and are the values of a constant one") {
    for (DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar,
                                DiskMapping::EqualArea, DiskMapping::Polar}) {
        CHECK(tabulate(*makeBrdf("gold"), 12, mapping, TexelValue::Mean).asymmetry < 1e-5f);
        const auto brdf = makeBrdf("gray-diffuse");
        const BrdfTable means = tabulate(*brdf, 12, mapping, TexelValue::Mean),
                        centers = tabulate(*brdf, 12, mapping, TexelValue::Center);
        CHECK((means.channels[0] - centers.channels[0]).cwiseAbs().maxCoeff() < 1e-6f);
    }
}

TEST_CASE("tabulation: means are nearer to those of many samples than centers are") {
    const auto brdf = makeBrdf(R"({"model": "cook-torrance", "diffuse": 0, "f0": 0.5, "roughness": 0.2})");
    const BrdfTable means = tabulate(*brdf, 8, DiskMapping::EqualArea, TexelValue::Mean),
                    centers = tabulate(*brdf, 8, DiskMapping::EqualArea, TexelValue::Center);
    const Eigen::MatrixXf exact = bruteForceMeans(*brdf, means);
    Eigen::VectorXf cosines(exact.rows());
    for (size_t i = 0; i < means.directions.size(); i++) cosines[Eigen::Index(i)] = means.directions[i].z;
    const auto errorOf = [&](const BrdfTable& table) {
        const Eigen::MatrixXf error = table.channels[0] - exact;
        return (cosines.asDiagonal() * error * cosines.asDiagonal()).norm() /
               (cosines.asDiagonal() * exact * cosines.asDiagonal()).norm();
    };
    CHECK(errorOf(means) < 0.5f * errorOf(centers));
    const auto total = [&](const Eigen::MatrixXf& matrix) { return cosines.dot(matrix * cosines); };
    // So small a map has but a few hundred pairs of texels that no turn exchanges.
    CHECK(total(means.channels[0]) == doctest::Approx(total(exact)).epsilon(0.03));
}
