// Tests measurement of errors against brute force, and with BRDFs that a factorization represents exactly.
#include "engine/light/light.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/tabulation.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// A BRDF that is a factorization.
class Exact final : public Brdf {
  public:
    explicit Exact(const FactoredBrdf& factored) : mFactored(factored) {}
    vec3 evaluate(vec3 incoming, vec3 outgoing) const override {
        return relume::evaluate(mFactored, incoming, outgoing);
    }
    nlohmann::json describe() const override { return {{"model", "exact"}}; }

  private:
    const FactoredBrdf& mFactored;
};

LightCube constantLight(int size) {
    return {size, std::vector<vec3>(size_t(6 * size * size), vec3(1, 2, 3))};
}

LightCube skyLight(int size) { return sampleEnvironment(prepareForSampling(makeSky()), size, 0); }

// E[L(ω) L(ω')] of light_metric.h's lights, integrated over two texels; without the cosines.
MatrixXd correlationOf(const BrdfTable& table) {
    const auto n = Index(table.directions.size());
    return MatrixXd::NullaryExpr(n, n, [&](Index i, Index j) {
        const double cosine =
            glm::dot(glm::dvec3(table.directions[size_t(i)]), glm::dvec3(table.directions[size_t(j)]));
        double value = i == j ? 0.02 / double(table.solidAngles[size_t(i)]) : 0;
        for (unsigned l = 0; l <= 30; l++)
            value += (2 * l + 1) / (4 * double(kPi)) * std::pow(1.0 + l, -1.5) *
                     std::legendre(l, std::clamp(cosine, -1.0, 1.0));
        return value * double(table.solidAngles[size_t(i)]) * double(table.solidAngles[size_t(j)]);
    });
}

// Σ over outgoing directions of cosθ · solid angle · E[(∫ L e cosθ)²].
double meanSquare(const MatrixXd& error, const BrdfTable& table, const MatrixXd& correlation) {
    double sum = 0;
    for (Index o = 0; o < error.cols(); o++) {
        Eigen::VectorXd lit = error.col(o);
        for (Index i = 0; i < lit.size(); i++) lit[i] *= double(table.directions[size_t(i)].z);
        sum +=
            double(table.directions[size_t(o)].z * table.solidAngles[size_t(o)]) * lit.dot(correlation * lit);
    }
    return sum;
}

} // namespace

TEST_CASE("factorization errors: what is expected is what dense sums over lights and views give") {
    for (const DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::EqualArea}) {
        const BrdfTable table = tabulate(*makeBrdf("clay"), 8, mapping, TexelValue::Mean);
        const FactoredBrdf factored = factorize(table, {6});
        const std::vector<float> errors = expectedErrors(table, factored);
        const MatrixXd correlation = correlationOf(table);
        const auto n = Index(table.directions.size());
        for (int terms = 1; terms <= factored.terms; terms++) {
            double error = 0, total = 0;
            for (int c = 0; c < 3; c++) {
                const MatrixXd exact = table.channels[size_t(c)].cast<double>();
                const MatrixXd sum = MatrixXd::NullaryExpr(n, n, [&](Index i, Index o) {
                    const ivec2 lit = table.texels[size_t(i)], seen = table.texels[size_t(o)];
                    double value = 0;
                    for (int k = 0; k < terms; k++)
                        value += double(factored.lightMap(k)[lit.y * 8 + lit.x][c]) *
                                 double(factored.viewMap(0, k)[seen.y * 8 + seen.x][c]);
                    return value;
                });
                error += meanSquare(exact - sum, table, correlation);
                total += meanSquare(exact, table, correlation);
            }
            CHECK(errors[size_t(terms - 1)] == doctest::Approx(std::sqrt(error / total)).epsilon(2e-3));
        }
    }
}

TEST_CASE("factorization errors: none where the BRDF is what its terms are") {
    for (const DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar,
                                      DiskMapping::EqualArea, DiskMapping::Polar}) {
        const FactoredBrdf factored =
            factorize(tabulate(*makeBrdf("red-plastic"), 12, mapping), {4, Factorization::NonNegative});
        const Exact brdf(factored);
        CHECK(rmsErrors(brdf, factored, 0, 1, 2000).relative.back() < 1e-5f);
        const LayerOf layer{&factored};
        for (const LightCube& light : {constantLight(16), skyLight(16)})
            for (const bool uniform : {false, true}) {
                const auto errors = radianceErrors(brdf, std::span(&layer, 1), light, {8, uniform});
                REQUIRE(errors[0].size() == 4);
                CHECK(errors[0].front() > 0.01f);
                CHECK(errors[0].back() < 1e-5f);
            }
    }
    const auto diffuse = makeBrdf("gray-diffuse");
    const FactoredBrdf factored = factorize(tabulate(*diffuse, 16, DiskMapping::EqualArea), {1});
    const LayerOf layer{&factored};
    CHECK(radianceErrors(*diffuse, std::span(&layer, 1), constantLight(32), {20})[0][0] < 1e-5f);
}

TEST_CASE("factorization errors: lights and factorizations measured together are those measured alone") {
    const auto brdf = makeBrdf("ashikhmin-shirley");
    const BrdfTable table = tabulate(*brdf, 16, DiskMapping::EqualArea);
    const FactoredBrdf few = factorize(table, {3}), paper = factorize(table, {8, Factorization::Paper});
    const std::vector<LayerOf> layers = {{&few}, {&paper}};
    const std::vector<LightCube> lights = {
        skyLight(16), sampleLight({.distant = {{{0.3f, 0.9f, 0.2f}, vec3(1, 0.8f, 0.5f)}}}, 16)};
    const auto together = radianceErrors(*brdf, layers, lights, {10});
    for (size_t l = 0; l < 2; l++)
        for (size_t a = 0; a < 2; a++)
            CHECK(radianceErrors(*brdf, std::span(&layers[a], 1), lights[l], {10})[0] == together[l][a]);
}
