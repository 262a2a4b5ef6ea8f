#include "precompute/brdf/factorization.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/log.h"
#include "precompute/brdf/eigenpairs.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/light_metric.h"
#include "precompute/brdf/low_rank.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <tbb/parallel_for.h>

namespace relume {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXf;

namespace {

constexpr float kReciprocalAsymmetry = 1e-3f; // rounding and tabulated fits stay below this
constexpr float kDroppedTerm = 1e-5f;         // relative to the first term

constexpr std::string_view kNames[] = {"paper", "cosine", "environment", "nonnegative", "normalized"};

// Factors of one channel: per layer j, M_j ≈ Σk light_k view_jkᵀ.
struct ChannelFactors {
    VectorXf values;
    MatrixXf light;             // n × terms
    std::vector<MatrixXf> view; // per layer, n × terms

    // Returns the number of terms worth keeping.
    int terms() const {
        const auto counts = values.cwiseAbs().array() > kDroppedTerm * std::abs(values[0]);
        return int(counts.count());
    }
};

bool areIsotropic(std::span<const BrdfTable> tables) {
    return std::ranges::all_of(tables, &BrdfTable::isIsotropic);
}

// Square roots of the weights of errors of f. A factorization minimizes ‖light · error · diag(view)‖.
struct Weights {
    MatrixXf light;     // n × n, upper triangular; empty if diagonal
    VectorXf lightRoot; // its diagonal, if `light` is empty
    VectorXf view;

    MatrixXf apply(const MatrixXf& matrix) const {
        if (light.size() == 0) return lightRoot.asDiagonal() * matrix * view.asDiagonal();
        const MatrixXf seen = matrix * view.asDiagonal();
        return light.triangularView<Eigen::Upper>() * seen;
    }
};

// Nine terms resolve little of an anisotropic lobe at grazing angles, and there is no residual of bounced
// light, which then is too dark there. So these views count for more, cos^.65 θo instead of cosθo.
Weights weightsOf(std::span<const BrdfTable> tables, Factorization method) {
    const BrdfTable& table = tables[0];
    const auto n = Index(table.directions.size());
    if (method == Factorization::Environment) return {lightMetric(table), {}, viewMetric(table)};
    VectorXf root = VectorXf::Ones(n);
    if (method != Factorization::Paper)
        for (Index i = 0; i < n; i++)
            root[i] = table.directions[size_t(i)].z * std::sqrt(table.solidAngles[size_t(i)]);
    if (method == Factorization::NonNegative) {
        VectorXf view = viewMetric(table);
        if (!areIsotropic(tables))
            for (Index o = 0; o < n; o++) view[o] *= std::pow(table.directions[size_t(o)].z, -0.175f);
        return {{}, root, view};
    }
    return {{}, root, root};
}

// Makes each light map positive where its magnitude is largest, so that rounding does not decide signs.
void settleSigns(ChannelFactors& factors) {
    for (Index k = 0; k < factors.light.cols(); k++) {
        const auto map = factors.light.col(k);
        const float threshold = 0.999f * map.cwiseAbs().maxCoeff();
        const auto first =
            std::find_if(map.begin(), map.end(), [&](float v) { return std::abs(v) >= threshold; });
        if (first == map.end() || *first >= 0) continue;
        factors.light.col(k) *= -1;
        for (MatrixXf& view : factors.view) view.col(k) *= -1;
    }
}

ChannelFactors factorizeSymmetric(const MatrixXf& matrix, const VectorXf& root, int terms) {
    const MatrixXf weighted = root.asDiagonal() * matrix * root.asDiagonal();
    const MatrixXf symmetric = (weighted + weighted.transpose()) / 2; // removes rounding errors of the model
    const Eigenpairs pairs = largestEigenpairs(symmetric, terms);
    ChannelFactors factors;
    factors.values = pairs.values;
    factors.light =
        root.cwiseInverse().asDiagonal() * pairs.vectors * pairs.values.cwiseAbs().cwiseSqrt().asDiagonal();
    factors.view = {factors.light * pairs.values.cwiseSign().asDiagonal()};
    return factors;
}

ChannelFactors factorizeGeneral(const std::vector<const MatrixXf*>& matrices, const Weights& weights,
                                Factorization method, int terms) {
    std::vector<MatrixXf> blocks;
    std::vector<float> sizes;
    for (const MatrixXf* matrix : matrices) {
        blocks.push_back(weights.apply(*matrix));
        const float norm = blocks.back().norm();
        sizes.push_back(norm > 0 ? norm : 1); // 1 for black
        blocks.back() /= sizes.back();
    }
    const bool nonNegative = method == Factorization::NonNegative;
    const LowRank found = nonNegative ? nonNegativeLowRank(blocks, terms) : lowRank(blocks, terms);

    ChannelFactors factors;
    factors.values = found.values;
    if (matrices.size() == 1) factors.values *= sizes[0];
    const VectorXf root = found.values.cwiseSqrt();
    const VectorXf inverse = root.unaryExpr([](float v) { return v > 0 ? 1 / v : 0.0f; });
    if (nonNegative)
        factors.light = weights.lightRoot.cwiseInverse().asDiagonal() * found.left * root.asDiagonal();
    else
        // Compute light factors for these view factors without dividing by the light's weights.
        factors.light = MatrixXf::Zero(found.left.rows(), terms);
    for (size_t j = 0; j < matrices.size(); j++) {
        if (!nonNegative)
            factors.light.noalias() += *matrices[j] * (weights.view.asDiagonal() * found.right[j] *
                                                       (inverse / sizes[j]).asDiagonal());
        factors.view.push_back(weights.view.cwiseInverse().asDiagonal() * found.right[j] *
                               (root * sizes[j]).asDiagonal());
    }
    settleSigns(factors);
    return factors;
}

ChannelFactors factorizeNormalized(const std::vector<const MatrixXf*>& matrices) {
    ChannelFactors factors;
    VectorXf profile = VectorXf::Zero(matrices[0]->rows());
    Index directions = 0;
    float squared = 0;
    for (const MatrixXf* matrix : matrices) {
        const VectorXf norms = matrix->colwise().norm().transpose();
        for (Index o = 0; o < norms.size(); o++)
            if (norms[o] > 0) profile += matrix->col(o) / norms[o];
        directions += (norms.array() > 0).count();
        squared += norms.squaredNorm();
        factors.view.emplace_back(norms);
    }
    factors.light = profile / float(std::max<Index>(directions, 1));
    factors.values = VectorXf::Constant(1, factors.light.norm() * std::sqrt(squared));
    return factors;
}

void writeChannel(const ChannelFactors& factors, const std::vector<int>& nearest, int channel,
                  FactoredBrdf& brdf) {
    const auto write = [&](std::vector<vec3>& maps, int first, const MatrixXf& values, int term) {
        vec3* map = &maps[size_t(first + term) * brdf.mapTexels()];
        for (size_t texel = 0; texel < nearest.size(); texel++)
            map[texel][channel] = values(nearest[texel], term);
    };
    for (int term = 0; term < std::min(factors.terms(), brdf.terms); term++) {
        brdf.eigenvalues[size_t(term)][size_t(channel)] = factors.values[term];
        write(brdf.lightMaps, 0, factors.light, term);
        for (int layer = 0; layer < brdf.layers; layer++)
            write(brdf.viewMaps, layer * brdf.terms, factors.view[size_t(layer)], term);
    }
}

// Returns, per channel, the first channel that has the same values in all tables; this may be itself.
std::array<size_t, 3> firstEqualChannels(std::span<const BrdfTable> tables) {
    const auto equal = [&](size_t a, size_t b) {
        return std::all_of(tables.begin(), tables.end(),
                           [&](const BrdfTable& table) { return table.channels[a] == table.channels[b]; });
    };
    std::array<size_t, 3> first{};
    for (size_t c = 0; c < 3; c++)
        while (first[c] < c && !equal(first[c], c)) first[c]++;
    return first;
}

// Scales the view maps of every layer and direction, so that the terms reflect as much of an even light as
// the matrix. Least squares alone leave Ashikhmin-Shirley a seventh too bright from above and up to 40 % too
// dark at grazing angles, which bounced light shows.
void matchAlbedo(const BrdfTable& table, const std::vector<const MatrixXf*>& matrices,
                 ChannelFactors& factors) {
    VectorXf irradiance(Index(table.directions.size())); // by a radiance of 1 from each direction
    for (Index i = 0; i < irradiance.size(); i++)
        irradiance[i] = table.directions[size_t(i)].z * table.solidAngles[size_t(i)];
    const VectorXf light = factors.light.transpose() * irradiance;
    for (size_t j = 0; j < matrices.size(); j++) {
        const VectorXf wanted = matrices[j]->transpose() * irradiance, found = factors.view[j] * light;
        for (Index o = 0; o < wanted.size(); o++)
            if (found[o] > 0) factors.view[j].row(o) *= wanted[o] / found[o];
    }
}

// Factors all channels with one set of gray light maps. Nonnegative factorization has many local optima:
// channels factored separately end in different ones, and errors of their terms then tint gray materials.
// Transport of gray light maps also takes less than half the bytes.
std::array<ChannelFactors, 3> factorizeTogether(std::span<const BrdfTable> tables,
                                                const std::array<size_t, 3>& first, const Weights& weights,
                                                int terms) {
    std::vector<const MatrixXf*> matrices;
    for (const BrdfTable& table : tables)
        for (size_t c = 0; c < 3; c++)
            if (first[c] == c) matrices.push_back(&table.channels[c]);
    ChannelFactors all = factorizeGeneral(matrices, weights, Factorization::NonNegative, terms);
    matchAlbedo(tables[0], matrices, all);
    const size_t distinct = matrices.size() / tables.size();
    std::array<ChannelFactors, 3> factors;
    size_t next = 0; // index of the next factored channel
    for (size_t c = 0; c < 3; c++) {
        if (first[c] != c) {
            factors[c] = factors[first[c]];
            continue;
        }
        factors[c] = {all.values, all.light, {}};
        for (size_t layer = 0; layer < tables.size(); layer++)
            factors[c].view.push_back(all.view[layer * distinct + next]);
        next++;
    }
    return factors;
}

std::array<ChannelFactors, 3> factorizeChannels(std::span<const BrdfTable> tables, Factorization method,
                                                int terms) {
    const Weights weights = weightsOf(tables, method);
    const bool isSymmetric = tables.size() == 1 && tables[0].asymmetry <= kReciprocalAsymmetry &&
                             (method == Factorization::Paper || method == Factorization::Cosine);
    const std::array<size_t, 3> first = firstEqualChannels(tables);
    if (method == Factorization::NonNegative) return factorizeTogether(tables, first, weights, terms);
    std::array<ChannelFactors, 3> factors;
    tbb::parallel_for(size_t(0), size_t(3), [&](size_t c) {
        if (first[c] != c) return;
        std::vector<const MatrixXf*> matrices;
        for (const BrdfTable& table : tables) matrices.push_back(&table.channels[c]);
        factors[c] = method == Factorization::Normalized ? factorizeNormalized(matrices)
                     : isSymmetric ? factorizeSymmetric(*matrices[0], weights.view, terms)
                                   : factorizeGeneral(matrices, weights, method, terms);
    });
    for (size_t c = 0; c < 3; c++)
        if (first[c] != c) factors[c] = factors[first[c]];
    return factors;
}

FactoredBrdf assemble(std::span<const BrdfTable> tables, const std::array<ChannelFactors, 3>& channels,
                      int terms) {
    FactoredBrdf brdf;
    brdf.size = tables[0].size;
    brdf.mapping = tables[0].mapping;
    brdf.layers = int(tables.size());
    brdf.terms = terms;
    brdf.lightMaps.assign(size_t(terms) * brdf.mapTexels(), vec3(0));
    brdf.viewMaps.assign(size_t(brdf.layers * terms) * brdf.mapTexels(), vec3(0));
    brdf.eigenvalues.assign(size_t(terms), {0, 0, 0});
    const std::vector<int> nearest = nearestDirections(tables[0]);
    for (int c = 0; c < 3; c++) writeChannel(channels[size_t(c)], nearest, c, brdf);
    return brdf;
}

// Returns the smallest number of terms whose error is at most `wanted` for every layer.
int termsFor(float wanted, std::span<const BrdfTable> tables, const FactoredBrdf& brdf) {
    std::vector<float> worst(size_t(brdf.terms), 0);
    for (const std::vector<float>& errors : expectedErrors(tables, brdf))
        for (size_t k = 0; k < worst.size(); k++) worst[k] = std::max(worst[k], errors[k]);
    const auto enough =
        std::find_if(worst.begin(), worst.end(), [&](float error) { return error <= wanted; });
    if (enough != worst.end()) return int(enough - worst.begin()) + 1;
    log(LogLevel::Warning,
        fmt::format(
            "an error of {} is not reached: {} BRDF terms, all there are to choose from, leave {:.3g}; going "
            "on with these",
            wanted, brdf.terms, worst.back()));
    return brdf.terms;
}

// Returns K where none is given.
int defaultTerms(std::span<const BrdfTable> tables, Factorization method) {
    if (method == Factorization::Normalized) return 1;
    return method == Factorization::NonNegative && !areIsotropic(tables) ? kAnisotropicTerms
                                                                         : kIsotropicTerms;
}

} // namespace

std::string_view factorizationName(Factorization method) { return kNames[size_t(method)]; }

std::optional<Factorization> factorizationFromName(std::string_view name) {
    const auto found = std::find(std::begin(kNames), std::end(kNames), name);
    if (found == std::end(kNames)) return std::nullopt;
    return Factorization(found - std::begin(kNames));
}

bool isPublished(Factorization method) {
    return method == Factorization::Paper || method == Factorization::Normalized;
}

DiskMapping defaultMapping(Factorization method) {
    return isPublished(method) ? DiskMapping::Orthographic : DiskMapping::EqualArea;
}

TexelValue texelValueOf(Factorization method) {
    return isPublished(method) ? TexelValue::Center : TexelValue::Mean;
}

FactoredBrdf factorize(std::span<const BrdfTable> tables, const FactorizationOptions& options) {
    const int most = options.terms.value_or(defaultTerms(tables, options.method));
    if (most < 1 || most > kMostTerms)
        throw UsageError(fmt::format("{} BRDF terms: choose from 1 to {}", most, kMostTerms));
    if (options.wantedError && options.method == Factorization::NonNegative)
        throw UsageError(
            "terms chosen by error need terms that are good one by one, which those of factorization "
            "\"nonnegative\" are not: give their number");
    if (most != 1 && options.method == Factorization::Normalized)
        throw UsageError(fmt::format("factorization \"normalized\" has one term, not {}", most));
    RELUME_CHECK(!tables.empty());
    for (const BrdfTable& table : tables) {
        RELUME_CHECK(!table.directions.empty());
        RELUME_CHECK(table.size == tables[0].size && table.mapping == tables[0].mapping);
        if (table.asymmetry > kReciprocalAsymmetry && options.method != Factorization::Normalized)
            log(LogLevel::Warning,
                fmt::format(
                    "BRDF is not reciprocal (asymmetry {:.2g}): factored by SVD, with light and view maps "
                    "of their own",
                    table.asymmetry));
    }
    const int wanted = std::min(most, int(tables[0].directions.size()));
    const std::array<ChannelFactors, 3> channels = factorizeChannels(tables, options.method, wanted);
    int terms = 1; // a black BRDF has one term of zeros
    for (const ChannelFactors& factors : channels) terms = std::max(terms, factors.terms());
    FactoredBrdf brdf = assemble(tables, channels, terms);
    if (!options.wantedError) return brdf;
    const int enough = termsFor(*options.wantedError, tables, brdf);
    return enough == terms ? brdf : assemble(tables, channels, enough);
}

FactoredBrdf factorize(const BrdfTable& table, const FactorizationOptions& options) {
    return factorize(std::span(&table, 1), options);
}

} // namespace relume
