#include "precompute/brdf/factorization.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "precompute/brdf/eigenpairs.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

namespace relume {

using Eigen::MatrixXf;
using Eigen::VectorXf;

namespace {

constexpr float kReciprocalAsymmetry = 1e-3f; // rounding and tabulated fits stay below
constexpr float kDroppedTerm = 1e-6f;         // relative to the first

// M ≈ Σk light_k view_kᵀ of one channel.
struct ChannelFactors {
    VectorXf values;      // eigenvalues, or singular values, by falling magnitude
    MatrixXf light, view; // n × values

    // How many are worth keeping.
    int terms() const {
        const auto counts = values.cwiseAbs().array() > kDroppedTerm * std::abs(values[0]);
        return int(counts.count());
    }
};

ChannelFactors factorizeSymmetric(const MatrixXf& matrix, int terms) {
    const MatrixXf symmetric = (matrix + matrix.transpose()) / 2; // rounding errors of the model removed
    const Eigenpairs pairs = largestEigenpairs(symmetric, terms);
    ChannelFactors factors;
    factors.values = pairs.values;
    factors.light = pairs.vectors * pairs.values.cwiseAbs().cwiseSqrt().asDiagonal();
    factors.view = factors.light * pairs.values.cwiseSign().asDiagonal();
    return factors;
}

// Singular triplets σ, u, v of M are the eigenpairs ±σ, (u, ±v) / √2 of the symmetric [0 M; Mᵀ 0]: the same
// iteration finds them without squaring M, which would lose the small ones.
ChannelFactors factorizeUnsymmetric(const MatrixXf& matrix, int terms) {
    const Eigen::Index n = matrix.rows();
    const auto apply = [&](const MatrixXf& block) {
        MatrixXf product(2 * n, block.cols());
        product.topRows(n).noalias() = matrix * block.bottomRows(n);
        product.bottomRows(n).noalias() = matrix.transpose() * block.topRows(n);
        return product;
    };
    const Eigenpairs pairs = largestEigenpairs(apply, int(2 * n), 2 * terms);
    ChannelFactors factors{VectorXf::Zero(terms), MatrixXf::Zero(n, terms), MatrixXf::Zero(n, terms)};
    int term = 0;
    for (int k = 0; k < 2 * terms && term < terms; k++) {
        if (pairs.values[k] <= 0) continue;
        factors.values[term] = pairs.values[k];
        const VectorXf scaled = std::sqrt(2 * pairs.values[k]) * pairs.vectors.col(k);
        factors.light.col(term) = scaled.head(n);
        factors.view.col(term) = scaled.tail(n);
        term++;
    }
    return factors;
}

// For every texel of the map, the index of the nearest direction's texel: itself inside the disk, the
// nearest inside texel (the first of equals) outside it.
std::vector<int> nearestDirections(const BrdfTable& table) {
    std::vector<int> nearest(size_t(table.size) * size_t(table.size));
    for (int y = 0; y < table.size; y++)
        for (int x = 0; x < table.size; x++) {
            int least = INT_MAX;
            for (size_t i = 0; i < table.texels.size() && least > 0; i++) {
                const ivec2 offset = table.texels[i] - ivec2(x, y);
                const int distance = offset.x * offset.x + offset.y * offset.y;
                if (distance >= least) continue;
                least = distance;
                nearest[size_t(y * table.size + x)] = int(i);
            }
        }
    return nearest;
}

void writeChannel(const ChannelFactors& factors, const std::vector<int>& nearest, int channel,
                  FactoredBrdf& brdf) {
    for (int term = 0; term < factors.terms(); term++) {
        brdf.eigenvalues[size_t(term)][size_t(channel)] = factors.values[term];
        const size_t start = size_t(term) * brdf.mapTexels();
        for (size_t texel = 0; texel < nearest.size(); texel++) {
            brdf.lightMaps[start + texel][channel] = factors.light(nearest[texel], term);
            brdf.viewMaps[start + texel][channel] = factors.view(nearest[texel], term);
        }
    }
}

// For each channel the first channel with the same values: itself unless it repeats an earlier one.
std::array<int, 3> firstEqualChannels(const BrdfTable& table) {
    std::array<int, 3> first{};
    for (int c = 0; c < 3; c++)
        while (first[size_t(c)] < c && table.channels[size_t(first[size_t(c)])] != table.channels[size_t(c)])
            first[size_t(c)]++;
    return first;
}

std::array<ChannelFactors, 3> factorizeChannels(const BrdfTable& table, int terms) {
    const bool symmetric = table.asymmetry <= kReciprocalAsymmetry;
    if (!symmetric)
        spdlog::warn("BRDF is not reciprocal (asymmetry {:.2g}): factored by SVD, with light and view maps "
                     "of their own",
                     table.asymmetry);
    const std::array<int, 3> first = firstEqualChannels(table);
    std::array<ChannelFactors, 3> factors;
    tbb::parallel_for(size_t(0), size_t(3), [&](size_t c) {
        if (first[c] != int(c)) return;
        const MatrixXf& matrix = table.channels[c];
        factors[c] = symmetric ? factorizeSymmetric(matrix, terms) : factorizeUnsymmetric(matrix, terms);
    });
    for (size_t c = 0; c < 3; c++)
        if (first[c] != int(c)) factors[c] = factors[size_t(first[c])];
    return factors;
}

} // namespace

FactoredBrdf factorize(const BrdfTable& table, const FactorizationOptions& options) {
    if (options.terms < 1 || options.terms > kMaxTerms)
        throw UsageError("{} BRDF terms: choose from 1 to {}", options.terms, kMaxTerms);
    RELUME_CHECK(!table.directions.empty());
    const int wanted = std::min(options.terms, int(table.directions.size()));
    const std::array<ChannelFactors, 3> channels = factorizeChannels(table, wanted);

    FactoredBrdf brdf;
    brdf.size = table.size;
    brdf.mapping = table.mapping;
    brdf.terms = 1; // a black BRDF has one, of zeros
    for (const ChannelFactors& factors : channels) brdf.terms = std::max(brdf.terms, factors.terms());
    brdf.lightMaps.assign(size_t(brdf.terms) * brdf.mapTexels(), vec3(0));
    brdf.viewMaps.assign(size_t(brdf.terms) * brdf.mapTexels(), vec3(0));
    brdf.eigenvalues.assign(size_t(brdf.terms), {0, 0, 0});
    const std::vector<int> nearest = nearestDirections(table);
    for (int c = 0; c < 3; c++) writeChannel(channels[size_t(c)], nearest, c, brdf);
    return brdf;
}

} // namespace relume
