#include "precompute/brdf/factorization_error.h"

#include "engine/base/check.h"
#include "precompute/brdf/light_metric.h"
#include "precompute/brdf/random_directions.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;

namespace {

struct ChannelMaps {
    MatrixXf light, view; // n × terms, at the table's texels
};

ChannelMaps mapsOf(const BrdfTable& table, const FactoredBrdf& factored, int layer, int channel) {
    const auto n = Index(table.texels.size());
    ChannelMaps maps{MatrixXf(n, factored.terms), MatrixXf(n, factored.terms)};
    for (int term = 0; term < factored.terms; term++)
        for (Index i = 0; i < n; i++) {
            const ivec2 texel = table.texels[size_t(i)];
            const int place = texel.y * factored.size + texel.x;
            maps.light(i, term) = factored.lightMap(term)[place][channel];
            maps.view(i, term) = factored.viewMap(layer, term)[place][channel];
        }
    return maps;
}

// The squared error of a factorization of `target`.
struct Residuals {
    double total = 0; // ‖target‖²
    VectorXd terms;   // ‖target - Σ left_k right_kᵀ‖² after each term
};

// Returns the residuals by products with the factors, without forming their sum. columns(first, count)
// returns a range of the target's columns; it is called once for each range, in parallel.
template <typename Columns>
Residuals residualsOf(const ChannelMaps& maps, const Columns& columns) {
    constexpr Index kTogether = 128; // columns; a sum's rounding must not depend on the number of threads
    const MatrixXd left = maps.light.cast<double>(), right = maps.view.cast<double>();
    const Index ranges = (right.rows() + kTogether - 1) / kTogether;
    VectorXd totals(ranges);
    MatrixXd products(left.cols(), ranges);
    tbb::parallel_for(Index(0), ranges, [&](Index range) {
        const Index first = range * kTogether, count = std::min(kTogether, right.rows() - first);
        const MatrixXf target = columns(first, count);
        totals[range] = target.cast<double>().squaredNorm();
        products.col(range) =
            left.cwiseProduct((target * maps.view.middleRows(first, count)).template cast<double>())
                .colwise()
                .sum();
    });
    const MatrixXd grams = (left.transpose() * left).cwiseProduct(right.transpose() * right);
    const VectorXd product = products.rowwise().sum();
    Residuals residuals{totals.sum(), VectorXd(left.cols())};
    double residual = residuals.total;
    for (Index k = 0; k < left.cols(); k++) {
        residual += grams(k, k) + 2 * grams.col(k).head(k).sum() - 2 * product[k];
        residuals.terms[k] = std::max(residual, 0.0);
    }
    return residuals;
}

std::vector<float> relative(const VectorXd& residuals, double total) {
    std::vector<float> errors;
    for (const double residual : residuals)
        errors.push_back(total > 0 ? float(std::sqrt(residual / total)) : 0);
    return errors;
}

std::vector<float> expectedErrorsOf(const BrdfTable& table, const MatrixXf& lights, const VectorXf& views,
                                    const FactoredBrdf& factored, int layer) {
    VectorXd residuals = VectorXd::Zero(factored.terms);
    double total = 0;
    for (int c = 0; c < 3; c++) {
        ChannelMaps maps = mapsOf(table, factored, layer, c);
        maps.light = (lights.triangularView<Eigen::Upper>() * maps.light).eval();
        maps.view = (views.asDiagonal() * maps.view).eval();
        const Residuals channel = residualsOf(maps, [&](Index first, Index count) -> MatrixXf {
            const MatrixXf seen =
                table.channels[size_t(c)].middleCols(first, count) * views.segment(first, count).asDiagonal();
            return lights.triangularView<Eigen::Upper>() * seen;
        });
        residuals += channel.terms;
        total += channel.total;
    }
    return relative(residuals, total);
}

} // namespace

std::vector<float> frobeniusResiduals(const BrdfTable& table, const FactoredBrdf& factored, int layer) {
    std::vector<float> mean(size_t(factored.terms), 0);
    for (int c = 0; c < 3; c++) {
        const Residuals residuals =
            residualsOf(mapsOf(table, factored, layer, c), [&](Index first, Index count) -> MatrixXf {
                return table.channels[size_t(c)].middleCols(first, count);
            });
        const std::vector<float> errors = relative(residuals.terms, residuals.total);
        for (size_t k = 0; k < mean.size(); k++) mean[k] += errors[k] / 3;
    }
    return mean;
}

std::vector<float> expectedErrors(const BrdfTable& table, const FactoredBrdf& factored, int layer) {
    return expectedErrorsOf(table, lightMetric(table), viewMetric(table), factored, layer);
}

std::vector<std::vector<float>> expectedErrors(std::span<const BrdfTable> tables,
                                               const FactoredBrdf& factored) {
    RELUME_CHECK_EQ(tables.size(), size_t(factored.layers));
    const MatrixXf lights = lightMetric(tables[0]); // the same for all tables
    const VectorXf views = viewMetric(tables[0]);
    std::vector<std::vector<float>> errors;
    for (size_t layer = 0; layer < tables.size(); layer++)
        errors.push_back(expectedErrorsOf(tables[layer], lights, views, factored, int(layer)));
    return errors;
}

RmsErrors rmsErrors(const Brdf& brdf, const FactoredBrdf& factored, int layer, int layers, int pairs) {
    RELUME_CHECK_LE(1, pairs);
    RandomDirections random(80000);
    const auto terms = size_t(factored.terms);
    std::vector<glm::dvec3> differences(terms, glm::dvec3(0));
    glm::dvec3 total(0);
    for (int pair = 0; pair < pairs; pair++) {
        const vec3 incoming = random.uniformHemisphere(), outgoing = random.uniformHemisphere();
        const float weight = incoming.z * outgoing.z;
        const glm::dvec3 exact(weight * brdf.evaluate(incoming, outgoing));
        total += exact * exact;
        const MapPlace lit = placeInMap(factored.size, factored.mapping, incoming);
        const MapPlace seen = placeInMap(factored.size, factored.mapping, outgoing);
        vec3 sum(0);
        for (int term = 0; term < factored.terms; term++) {
            const vec3 light = lookupMap(factored.lightMap(term), lit);
            for (int l = layer; l < layer + layers; l++)
                sum += light * lookupMap(factored.viewMap(l, term), seen);
            const glm::dvec3 error = glm::dvec3(weight * sum) - exact;
            differences[size_t(term)] += error * error;
        }
    }
    RmsErrors errors;
    for (const glm::dvec3& difference : differences) {
        double relativeSum = 0;
        for (int c = 0; c < 3; c++)
            if (total[c] > 0) relativeSum += std::sqrt(difference[c] / total[c]); // a black channel has none
        const glm::dvec3 rms = glm::sqrt(difference / double(pairs));
        errors.absolute.push_back(float((rms.x + rms.y + rms.z) / 3));
        errors.relative.push_back(float(relativeSum / 3));
    }
    return errors;
}

} // namespace relume
