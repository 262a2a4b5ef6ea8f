#include "precompute/layout/conversion.h"

#include "engine/base/error.h"
#include "precompute/layout/basis_encoder.h"
#include "precompute/layout/basis_kinds.h"
#include "precompute/layout/cluster_encoder.h"
#include "precompute/layout/light_spectrum.h"
#include "precompute/layout/slope.h"
#include "precompute/reference/transport_stages.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr size_t kBatch = 32; // clusters between two reports of progress
constexpr ptrdiff_t kFirstCache = 32 << 10, kSecondCache = 256 << 10, kThirdCache = 2 << 20; // bytes

using Report = std::function<void(uint64_t done, uint64_t total)>;

std::vector<MaterialSet*> setsOf(Asset& asset) {
    std::vector<MaterialSet*> sets;
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) sets.push_back(&set);
    return sets;
}

uint64_t bytesOf(const std::vector<MaterialSet*>& sets) {
    uint64_t bytes = 0;
    for (const MaterialSet* set : sets) bytes += bytesOf(set->transport);
    return bytes;
}

SparseTransport makeRows(const Transport& transport, const Asset& asset) {
    SparseTransport rows;
    rows.vertices = verticesOf(transport);
    rows.terms = termsOf(transport);
    std::vector<PackedRow> packed(rows.rows());
    tbb::parallel_for(size_t(0), packed.size(), [&](size_t row) {
        const std::vector<vec3> coefficients =
            coefficientsOf(transport, row, size_t(6 * asset.faceSize * asset.faceSize));
        packed[row] = packRow(coefficients, selectLargest(coefficients, asset.coefficients));
    });
    rows.rowStarts.push_back(0);
    for (const PackedRow& row : packed) {
        rows.scales.push_back(row.scale);
        rows.indices.insert(rows.indices.end(), row.indices.begin(), row.indices.end());
        rows.values.insert(rows.values.end(), row.values.begin(), row.values.end());
        rows.rowStarts.push_back(rows.values.size());
    }
    return rows;
}

// Sets in rows, and what weighs their errors.
struct Source {
    std::vector<MaterialSet*> sets;
    std::vector<float> spectrum;
    std::vector<float> units; // per set
    uint64_t vertices = 0;    // over all sets: the sum of their squares, in their units

    Source(const std::vector<MaterialSet*>& from, int faceSize)
        : sets(from), spectrum(lightSpectrum(faceSize)) {
        for (const MaterialSet* set : sets) {
            units.push_back(transportUnit(rowsOf(set->transport), spectrum));
            vertices += rowsOf(set->transport).vertices;
        }
    }

    double relative(double squared) const {
        return std::sqrt(squared / double(std::max<uint64_t>(1, vertices)));
    }
    double squared(double relative) const { return relative * relative * double(vertices); }
};

double convertToClusters(const Source& source, const LayoutOptions& options, double budget) {
    std::vector<float> energies;
    double rowBytes = 0;
    for (size_t number = 0; number < source.sets.size(); number++) {
        const SparseTransport& rows = rowsOf(source.sets[number]->transport);
        const std::vector<float> own = columnEnergies(rows, source.spectrum, source.units[number]);
        energies.insert(energies.end(), own.begin(), own.end());
        rowBytes += double(rows.rows() * sizeof(float));
    }
    std::ranges::sort(energies, std::greater());
    constexpr double kColumnBytes = sizeof(uint16_t) + sizeof(uint32_t) * kClusterVertices;
    size_t kept = 0;
    if (options.bytesPerVertex)
        kept = size_t(std::clamp((budget - rowBytes) / kColumnBytes, 0.0, double(energies.size())));
    else {
        double left = 0;
        kept = energies.size();
        while (kept > 0 && left + double(energies[kept - 1]) <= source.squared(options.error))
            left += double(energies[--kept]);
    }
    // Of equal columns at the edge all are dropped, to stay within a budget.
    const float threshold = kept < energies.size()
                                ? std::nextafter(energies[kept], std::numeric_limits<float>::infinity())
                                : 0.0f;
    double error = 0;
    for (size_t number = 0; number < source.sets.size(); number++) {
        MaterialSet& set = *source.sets[number];
        EncodedClusters encoded =
            encodeClusters(rowsOf(set.transport), source.spectrum, source.units[number], threshold);
        error += encoded.error;
        set.transport = std::move(encoded.transport);
    }
    return source.relative(error);
}

// A cluster of all sets'.
struct Place {
    uint32_t set, first, count;
};

// Runs work(i) for all places, in parallel, and reports every so often.
template <typename Work>
void forEachPlace(std::span<const Place> places, uint64_t& done, uint64_t total, const Report& report,
                  const Work& work) {
    for (size_t start = 0; start < places.size(); start += kBatch) {
        const size_t end = std::min(start + kBatch, places.size());
        tbb::parallel_for(start, end, work);
        for (size_t i = start; i < end; i++) done += places[i].count;
        if (report) report(done / 2, total);
    }
}

double convertToBases(const Source& source, const LayoutOptions& options, double budget,
                      const Report& report) {
    std::vector<BasisTransport> made;
    std::vector<Place> places;
    for (const MaterialSet* set : source.sets) {
        const SparseTransport& rows = rowsOf(set->transport);
        for (uint32_t first = 0; first < rows.vertices; first += kBasisVertices)
            places.push_back({uint32_t(made.size()), first, std::min(kBasisVertices, rows.vertices - first)});
        made.push_back({rows.vertices, rows.terms, basisKinds(set->brdf), {}});
        made.back().clusters.resize(made.back().clusterCount());
    }
    const auto matrixOf = [&](const Place& place) {
        return clusterMatrix(rowsOf(source.sets[place.set]->transport), place.first, place.count,
                             made[place.set].kinds, source.spectrum, source.units[place.set],
                             kAnalysedColumns);
    };

    // The rows are read twice: once for what each cluster asks for, once for what it gets.
    uint64_t done = 0;
    std::vector<BasisAnalysis> analyses(places.size());
    forEachPlace(places, done, source.vertices, report,
                 [&](size_t i) { analyses[i] = analyse(matrixOf(places[i])); });
    const double price = options.bytesPerVertex ? priceForBytes(analyses, budget)
                                                : priceForError(analyses, source.squared(options.error));
    std::vector<double> errors(places.size());
    forEachPlace(places, done, source.vertices, report, [&](size_t i) {
        const Place& place = places[i];
        EncodedCluster encoded = encodeBases(matrixOf(place), analyses[i], cutFor(analyses[i], price),
                                             made[place.set].kinds, source.spectrum);
        made[place.set].clusters[place.first / kBasisVertices] = std::move(encoded.cluster);
        errors[i] = encoded.error;
        analyses[i] = {};
    });
    for (size_t number = 0; number < made.size(); number++)
        source.sets[number]->transport = std::move(made[number]);
    double error = 0;
    for (const double own : errors) error += own;
    return source.relative(error);
}

} // namespace

uint64_t verticesOf(const Asset& asset) {
    uint64_t vertices = 0;
    for (const AssetPart& part : asset.parts) vertices += part.mesh.vertexCount();
    return vertices;
}

Conversion convertLayout(Asset& asset, const LayoutOptions& options, const Report& progress) {
    // Eigen cuts products by the caches it finds, and sums would differ from one machine to another.
    Eigen::setCpuCacheSizes(kFirstCache, kSecondCache, kThirdCache);
    const std::vector<MaterialSet*> sets = setsOf(asset);
    Conversion conversion;
    conversion.bytesBefore = bytesOf(sets);
    const bool areShorter = options.coefficients && *options.coefficients < asset.coefficients;
    if (areShorter) asset.coefficients = *options.coefficients;
    for (MaterialSet* set : sets)
        if (areShorter || layoutOf(set->transport) != TransportLayout::Rows)
            set->transport = makeRows(set->transport, asset);
    if (options.layout != TransportLayout::Rows) {
        const Source source(sets, asset.faceSize);
        const double budget = options.bytesPerVertex.value_or(0) * double(verticesOf(asset));
        conversion.error = options.layout == TransportLayout::Clusters
                               ? convertToClusters(source, options, budget)
                               : convertToBases(source, options, budget, progress);
    }
    if (conversion.error && !std::isfinite(*conversion.error))
        throw Error(
            "transport is too large for numbers of 32 bits; bake it again, with a material of less gain");
    conversion.bytesAfter = bytesOf(sets);
    return conversion;
}

} // namespace relume
