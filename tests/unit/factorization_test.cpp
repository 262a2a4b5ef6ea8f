// Tests factorization from tables to light and view maps: what the terms reproduce, and what the maps
// contain.
#include "engine/base/error.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/tabulation.h"
#include "tests/support/singular_values.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <random>

using namespace relume;
using namespace relume::test;
using Eigen::MatrixXf;

namespace {

BrdfTable tableOf(const std::string& material, int size, DiskMapping mapping = DiskMapping::Orthographic) {
    return tabulate(*makeBrdf(material), size, mapping);
}

// The sum of the terms at two directions of the table, texel against texel.
MatrixXf reconstruct(const FactoredBrdf& brdf, const BrdfTable& table, int channel, int layer = 0) {
    const Eigen::Index n = Eigen::Index(table.directions.size());
    MatrixXf light(n, brdf.terms), view(n, brdf.terms);
    for (Eigen::Index i = 0; i < n; i++)
        for (int term = 0; term < brdf.terms; term++) {
            const ivec2 texel = table.texels[size_t(i)];
            const int place = texel.y * brdf.size + texel.x;
            light(i, term) = brdf.lightMap(term)[place][channel];
            view(i, term) = brdf.viewMap(layer, term)[place][channel];
        }
    return light * view.transpose();
}

// A table of 12 directions (4 × 4 texels) with any matrix.
BrdfTable tableWith(const MatrixXf& matrix) {
    BrdfTable table = tableOf("gray-diffuse", 4);
    REQUIRE(table.directions.size() == size_t(matrix.rows()));
    for (MatrixXf& channel : table.channels) channel = matrix;
    table.asymmetry = (matrix - matrix.transpose()).norm() / matrix.norm();
    return table;
}

} // namespace

TEST_CASE("factorization: a diffuse BRDF has one term and no error, up to the rim") {
    for (DiskMapping mapping : {DiskMapping::Orthographic, DiskMapping::EqualAreaPolar, DiskMapping::Polar}) {
        const auto brdf = makeBrdf(R"({"model": "diffuse", "albedo": [0.2, 0.5, 0.8]})");
        const FactoredBrdf factored = factorize(tabulate(*brdf, 16, mapping), {32});
        CHECK(factored.terms == 1);
        CHECK(factored.mapping == mapping);
        CHECK(rmsErrors(*brdf, factored, 0, 1, 10000).relative.back() < 1e-5f);
        const vec3 grazing = evaluate(factored, liftAboveHorizon({0.7f, 0.7f, 0}), {0, 0, 1});
        CHECK(glm::length(grazing * kPi - vec3(0.2f, 0.5f, 0.8f)) < 1e-5f);
    }
}

TEST_CASE("factorization: the normalized decomposition") {
    BrdfTable table = tableOf("clay", 6);
    const auto n = Eigen::Index(table.directions.size());
    const Eigen::VectorXf light = Eigen::VectorXf::LinSpaced(n, 1, 2),
                          view = Eigen::VectorXf::LinSpaced(n, 3, 0.5f);
    for (MatrixXf& channel : table.channels) channel = light * view.transpose();
    const FactoredBrdf product = factorize(table, {1, Factorization::Normalized});
    CHECK(product.terms == 1);
    CHECK((reconstruct(product, table, 0) - table.channels[0]).norm() < 1e-5f * table.channels[0].norm());

    // Two outgoing directions reflect one incoming direction each, the others reflect nothing.
    for (MatrixXf& channel : table.channels) {
        channel.setZero();
        channel(0, 0) = 3;
        channel(1, 1) = 4;
    }
    const MatrixXf mean = reconstruct(factorize(table, {1, Factorization::Normalized}), table, 1);
    CHECK(mean(0, 0) == doctest::Approx(1.5));
    CHECK(mean(1, 0) == doctest::Approx(1.5));
    CHECK(mean(0, 1) == doctest::Approx(2));
    CHECK(mean(2, 2) == 0);
    CHECK_THROWS_WITH_AS(factorize(table, {2, Factorization::Normalized}), doctest::Contains("one term"),
                         UsageError);
}

TEST_CASE("factorization: all terms together are the table") {
    for (const char* material : {"ashikhmin-shirley", "clay", "red-plastic"}) {
        const BrdfTable table = tableOf(material, 6);
        REQUIRE(table.directions.size() <= 32);
        const FactoredBrdf brdf = factorize(table, {32, Factorization::Paper});
        for (int c = 0; c < 3; c++) {
            const MatrixXf& exact = table.channels[size_t(c)];
            CHECK((reconstruct(brdf, table, c) - exact).norm() < 1e-4f * exact.norm());
        }
    }
}

TEST_CASE("factorization: what K terms miss is the rest of the spectrum") {
    const BrdfTable table = tableOf("skin", 16);
    const FactoredBrdf brdf = factorize(table, {8, Factorization::Paper});
    for (int c = 0; c < 3; c++) {
        const MatrixXf& exact = table.channels[size_t(c)];
        double kept = 0;
        for (const auto& values : brdf.eigenvalues) kept += std::pow(double(values[size_t(c)]), 2);
        const double rest = std::sqrt(double(exact.squaredNorm()) - kept);
        CHECK(double((reconstruct(brdf, table, c) - exact).norm()) == doctest::Approx(rest).epsilon(1e-2));
    }
}

TEST_CASE("factorization: light maps keep their sign, view maps take that of the eigenvalue") {
    const FactoredBrdf brdf = factorize(tableOf("clay", 16), {12, Factorization::Paper});
    CHECK(brdf.terms == 12);
    bool someNegative = false;
    for (int term = 0; term < brdf.terms; term++)
        for (int c = 0; c < 3; c++) {
            const float value = brdf.eigenvalues[size_t(term)][size_t(c)];
            if (term > 0)
                CHECK(std::abs(value) <=
                      std::abs(brdf.eigenvalues[size_t(term) - 1][size_t(c)]) * (1 + 1e-5f));
            someNegative |= value < 0;
            const float sign = value < 0 ? -1.0f : 1.0f;
            float largest = 0, lowest = 0;
            for (size_t texel = 0; texel < brdf.mapTexels(); texel++) {
                const size_t place = size_t(term) * brdf.mapTexels() + texel;
                CHECK(brdf.viewMaps[place][c] == sign * brdf.lightMaps[place][c]);
                largest = std::max(largest, brdf.lightMaps[place][c]);
                lowest = std::min(lowest, brdf.lightMaps[place][c]);
            }
            CHECK(largest >= -0.999f * lowest);
        }
    CHECK(someNegative);
}

TEST_CASE("factorization: texels outside the disk copy the nearest inside") {
    const int size = 12;
    const BrdfTable table = tableOf("ashikhmin-shirley", size);
    const FactoredBrdf brdf = factorize(table, {2, Factorization::Paper});
    std::vector<bool> inside(size * size, false);
    for (const ivec2& texel : table.texels) inside[size_t(texel.y * size + texel.x)] = true;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            if (inside[size_t(y * size + x)]) continue;
            // The inside texels at the least distance, in the order of their indices: the first counts.
            float least = 1e9f;
            size_t nearest = 0;
            for (int v = 0; v < size; v++)
                for (int u = 0; u < size; u++) {
                    const float distance = std::hypot(float(u - x), float(v - y));
                    if (!inside[size_t(v * size + u)] || distance >= least - 1e-4f) continue;
                    least = distance;
                    nearest = size_t(v * size + u);
                }
            for (size_t start : {size_t(0), brdf.mapTexels()}) {
                CHECK(brdf.lightMaps[start + size_t(y * size + x)] == brdf.lightMaps[start + nearest]);
                CHECK(brdf.viewMaps[start + size_t(y * size + x)] == brdf.viewMaps[start + nearest]);
            }
        }
}

TEST_CASE("factorization: an unsymmetric table is factored by its singular values") {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> uniform(0, 1);
    const MatrixXf matrix = MatrixXf::NullaryExpr(12, 12, [&] { return uniform(random); });
    const BrdfTable table = tableWith(matrix);
    const Eigen::VectorXf values = singularValues(matrix);
    const FactoredBrdf all = factorize(table, {12, Factorization::Paper});
    CHECK((reconstruct(all, table, 1) - matrix).norm() < 1e-4f * matrix.norm());
    const FactoredBrdf brdf = factorize(table, {4, Factorization::Paper});
    REQUIRE(brdf.terms == 4);
    for (int term = 0; term < 4; term++)
        CHECK(brdf.eigenvalues[size_t(term)][0] == doctest::Approx(values[term]).epsilon(1e-4));
    const float rest = values.tail(8).norm();
    CHECK((reconstruct(brdf, table, 2) - matrix).norm() == doctest::Approx(rest).epsilon(1e-3));
}

TEST_CASE("factorization: an unsymmetric table of one term has one, rows lit and columns seen") {
    const Eigen::VectorXf light = Eigen::VectorXf::LinSpaced(12, 1, 2),
                          view = Eigen::VectorXf::Constant(12, 3);
    const BrdfTable table = tableWith(light * view.transpose());
    const FactoredBrdf brdf = factorize(table, {8, Factorization::Paper});
    CHECK(brdf.terms == 1);
    CHECK((reconstruct(brdf, table, 0) - table.channels[0]).norm() < 1e-4f * table.channels[0].norm());
}

TEST_CASE("factorization: more terms, less error") {
    const auto brdf = makeBrdf("ashikhmin-shirley");
    const BrdfTable table = tabulate(*brdf, 24, DiskMapping::Orthographic);
    float last = 1;
    for (int terms : {1, 4, 16, 32}) {
        const float error = rmsErrors(*brdf, factorize(table, {terms}), 0, 1, 20000).relative.back();
        CHECK(error < last);
        last = error;
    }
    CHECK(last < 0.5f);
    const auto skin = makeBrdf("skin");
    CHECK(rmsErrors(*skin, factorize(tabulate(*skin, 48, DiskMapping::Orthographic), {16}), 0, 1, 20000)
              .relative.back() < 0.07f);
}

TEST_CASE("factorization: the same bytes every time, and equal channels equal") {
    const BrdfTable table = tableOf("ashikhmin-shirley", 16);
    const FactoredBrdf first = factorize(table, {6}), second = factorize(table, {6});
    CHECK(first.lightMaps == second.lightMaps);
    CHECK(first.viewMaps == second.viewMaps);
    for (const vec3& value : first.lightMaps) CHECK((value.x == value.y && value.y == value.z));
}

TEST_CASE("factorization: a black channel or BRDF is zero everywhere") {
    for (const Factorization method : {Factorization::Environment, Factorization::NonNegative}) {
        const FactoredBrdf black = factorize(tableOf(R"({"model": "diffuse", "albedo": 0})", 8), {4, method});
        CHECK(black.terms == 1);
        for (const vec3& value : black.lightMaps) CHECK(value == vec3(0));
        const FactoredBrdf red =
            factorize(tableOf(R"({"model": "diffuse", "albedo": [1, 0, 0]})", 8), {4, method});
        CHECK(red.terms == 1);
        for (const vec3& value : red.viewMaps) CHECK((value.x > 0 && value.y == 0 && value.z == 0));
    }
}

TEST_CASE("factorization: nonnegative terms have gray light maps, and what is nearly gray stays so") {
    const char* const steel =
        R"({"model": "ggx", "f0": [0.527, 0.509, 0.491], "roughness_u": 0.5, "roughness_v": 0.2})";
    for (const std::string& material : {std::string("gold"), std::string(steel)}) {
        const FactoredBrdf brdf =
            factorize(tableOf(material, 16, DiskMapping::EqualArea), {6, Factorization::NonNegative});
        REQUIRE(brdf.terms == 6);
        for (const vec3& value : brdf.lightMaps) CHECK((value.x == value.y && value.y == value.z));
    }
    // Channels that are factored one by one end in different optima.
    const FactoredBrdf brdf =
        factorize(tableOf(steel, 16, DiskMapping::EqualArea), {6, Factorization::NonNegative});
    const auto largest = glm::length(
        *std::ranges::max_element(brdf.viewMaps, {}, [](vec3 value) { return glm::length(value); }));
    for (const vec3& value : brdf.viewMaps)
        CHECK(glm::length(value / vec3(0.527f, 0.509f, 0.491f) * 0.509f - vec3(value.y)) < 0.04f * largest);
}

TEST_CASE("factorization: nonnegative terms reflect as much of an even light as f, into any view") {
    const std::vector<BrdfTable> tables = {tableOf("ashikhmin-shirley", 12, DiskMapping::EqualArea),
                                           tableOf("gold", 12, DiskMapping::EqualArea)};
    const FactoredBrdf brdf = factorize(tables, {.terms = 4, .method = Factorization::NonNegative});
    for (int layer = 0; layer < 2; layer++) {
        const BrdfTable& table = tables[size_t(layer)];
        Eigen::VectorXf irradiance(Eigen::Index(table.directions.size()));
        for (Eigen::Index i = 0; i < irradiance.size(); i++)
            irradiance[i] = table.directions[size_t(i)].z * table.solidAngles[size_t(i)];
        for (int channel = 0; channel < 3; channel++) {
            const Eigen::VectorXf wanted = table.channels[size_t(channel)].transpose() * irradiance,
                                  found = reconstruct(brdf, table, channel, layer).transpose() * irradiance;
            CHECK((found - wanted).cwiseQuotient(wanted).cwiseAbs().maxCoeff() < 1e-4f);
        }
    }
}

TEST_CASE("factorization: term counts out of range are refused") {
    const BrdfTable table = tableOf("clay", 4);
    for (int terms : {-1, 0, 33}) CHECK_THROWS_AS(factorize(table, {terms}), UsageError);
}

TEST_CASE("factorization: several tables share light maps, and all terms together are each of them") {
    const std::vector<BrdfTable> tables = {tableOf("ashikhmin-shirley", 6), tableOf("clay", 6),
                                           tableOf("gold", 6)};
    const FactoredBrdf brdf = factorize(tables, {32, Factorization::Environment});
    REQUIRE(brdf.layers == 3);
    for (int layer = 0; layer < 3; layer++)
        for (int c = 0; c < 3; c++) {
            const MatrixXf& exact = tables[size_t(layer)].channels[size_t(c)];
            CHECK((reconstruct(brdf, tables[size_t(layer)], c, layer) - exact).norm() < 2e-3f * exact.norm());
        }
}

TEST_CASE("factorization: of proportional BRDFs, and of a black one among them, one term serves all") {
    const std::vector<BrdfTable> tables = {tableOf(R"({"model": "diffuse", "albedo": [0.2, 0.5, 0.8]})", 12),
                                           tableOf(R"({"model": "diffuse", "albedo": 0.1})", 12),
                                           tableOf(R"({"model": "diffuse", "albedo": 0})", 12)};
    for (const Factorization method : {Factorization::Paper, Factorization::Cosine,
                                       Factorization::Environment, Factorization::NonNegative}) {
        const FactoredBrdf brdf = factorize(tables, {8, method});
        CHECK(brdf.terms == 1);
        const vec3 up(0, 0, 1);
        CHECK(glm::length(evaluate(brdf, up, up, 0) * kPi - vec3(0.2f, 0.5f, 0.8f)) < 1e-4f);
        CHECK(glm::length(evaluate(brdf, up, up, 1) * kPi - vec3(0.1f)) < 1e-4f);
        CHECK(evaluate(brdf, up, up, 2) == vec3(0));
    }
}

TEST_CASE("factorization: of a wanted error the fewest terms, as many as allowed where they do not suffice") {
    const BrdfTable table = tableOf("red-plastic", 16, DiskMapping::EqualArea);
    const std::vector<float> errors = expectedErrors(table, factorize(table, {32}));
    for (const float wanted : {0.3f, 0.2f, 0.1f}) {
        const FactoredBrdf brdf = factorize(table, {32, Factorization::Environment, wanted});
        const auto enough =
            std::find_if(errors.begin(), errors.end(), [&](float error) { return error <= wanted; });
        REQUIRE(enough != errors.end());
        CHECK(brdf.terms == int(enough - errors.begin()) + 1);
        const std::vector<float> own = expectedErrors(table, brdf);
        CHECK(own.back() <= wanted);
        CHECK(own.back() == doctest::Approx(*enough).epsilon(1e-3));
    }
    CHECK(factorize(table, {5, Factorization::Environment, 1e-3f}).terms == 5);
    // The worst layer decides.
    const std::vector<BrdfTable> both = {tableOf("gray-diffuse", 16, DiskMapping::EqualArea), table};
    const FactoredBrdf joint = factorize(both, {32, Factorization::Environment, 0.1f});
    for (int layer = 0; layer < 2; layer++)
        CHECK(expectedErrors(both[size_t(layer)], joint, layer).back() <= 0.1f);
    CHECK_THROWS_AS(factorize(table, {32, Factorization::NonNegative, 0.1f}), UsageError);
}

TEST_CASE("factorization: the first terms of many are what factoring with fewer gives") {
    const std::unique_ptr<Brdf> brdf = makeBrdf("ashikhmin-shirley");
    for (const Factorization method : {Factorization::Paper, Factorization::Environment}) {
        CAPTURE(factorizationName(method));
        const BrdfTable table = tabulate(*brdf, 16, DiskMapping::Orthographic, texelValueOf(method));
        const FactoredBrdf many = factorize(table, {.terms = 16, .method = method});
        const FactoredBrdf few = factorize(table, {.terms = 4, .method = method});
        double difference = 0, all = 0;
        for (size_t i = 0; i < few.lightMaps.size(); i++)
            for (int j = 0; j < 3; j++) {
                // Products of the two maps of a term: the sign is anyone's.
                const double a = double(many.lightMaps[i][j]) * double(many.viewMaps[i][j]);
                const double b = double(few.lightMaps[i][j]) * double(few.viewMaps[i][j]);
                difference += (a - b) * (a - b), all += b * b;
            }
        CHECK(difference < 1e-6 * all);
    }
}
