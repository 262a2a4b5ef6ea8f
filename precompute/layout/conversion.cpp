#include "precompute/layout/conversion.h"

#include "engine/base/error.h"
#include "precompute/layout/basis_encoder.h"
#include "precompute/layout/basis_kinds.h"
#include "precompute/layout/layout_scale.h"
#include "precompute/layout/light_spectrum.h"
#include "precompute/layout/row_packing.h"
#include "precompute/layout/same_sums.h"
#include "precompute/layout/slope.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr uint64_t kBatchVertices = 8192; // between two reports of progress
constexpr uint64_t kLayoutPasses = 2;     // over the rows that bases are made of

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

// Vertices of a set.
struct Place {
    uint32_t set, first, count;
};

std::vector<Place> placesOf(const std::vector<MaterialSet*>& sets, uint32_t vertices) {
    std::vector<Place> places;
    for (uint32_t set = 0; set < sets.size(); set++) {
        const uint32_t all = verticesOf(sets[set]->transport);
        for (uint32_t first = 0; first < all; first += vertices)
            places.push_back({set, first, std::min(vertices, all - first)});
    }
    return places;
}

// Tells how far passes over all places are.
class Passes {
  public:
    Passes(const std::vector<MaterialSet*>& sets, uint64_t passes, const Report& report)
        : mPasses(passes), mReport(report) {
        for (const MaterialSet* set : sets) mVertices += verticesOf(set->transport);
    }

    // Runs work(i) for all places, in parallel.
    template <typename Work>
    void run(std::span<const Place> places, const Work& work) {
        uint64_t vertices = 0; // in a batch
        for (size_t start = 0; start < places.size();) {
            size_t end = start;
            for (vertices = 0; end < places.size() && vertices < kBatchVertices; end++)
                vertices += places[end].count;
            tbb::parallel_for(start, end, work);
            mDone += vertices;
            if (mReport) mReport(mDone / mPasses, mVertices);
            start = end;
        }
    }

  private:
    uint64_t mPasses, mVertices = 0, mDone = 0;
    const Report& mReport;
};

void makeRows(const std::vector<MaterialSet*>& sets, const Asset& asset, Passes& passes) {
    constexpr uint32_t kTogether = 64;
    const std::vector<Place> places = placesOf(sets, kTogether);
    std::vector<std::vector<PackedRow>> packed(places.size());
    passes.run(places, [&](size_t i) {
        const Transport& transport = sets[places[i].set]->transport;
        const size_t terms = termsOf(transport), first = places[i].first * terms;
        for (size_t row = first; row < first + places[i].count * terms; row++) {
            const std::vector<vec3> coefficients =
                coefficientsOf(transport, row, size_t(6 * asset.faceSize * asset.faceSize));
            packed[i].push_back(packLargest(coefficients, asset.coefficients));
        }
    });
    std::vector<SparseTransport> made(sets.size());
    for (size_t set = 0; set < sets.size(); set++) {
        made[set].vertices = verticesOf(sets[set]->transport);
        made[set].terms = termsOf(sets[set]->transport);
        made[set].rowStarts.push_back(0);
    }
    for (size_t i = 0; i < places.size(); i++) {
        SparseTransport& rows = made[places[i].set];
        for (const PackedRow& row : packed[i]) {
            rows.scales.push_back(row.scale);
            rows.indices.insert(rows.indices.end(), row.indices.begin(), row.indices.end());
            rows.values.insert(rows.values.end(), row.values.begin(), row.values.end());
            rows.rowStarts.push_back(rows.values.size());
        }
        packed[i] = {};
    }
    for (size_t set = 0; set < sets.size(); set++) sets[set]->transport = std::move(made[set]);
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

double convertToBases(const Source& source, const LayoutOptions& options, double budget, Passes& passes) {
    std::vector<BasisTransport> made;
    for (const MaterialSet* set : source.sets) {
        const SparseTransport& rows = rowsOf(set->transport);
        made.push_back({rows.vertices, rows.terms, basisKinds(set->brdf), {}});
        made.back().clusters.resize(made.back().clusterCount());
    }
    const std::vector<Place> places = placesOf(source.sets, kBasisVertices);
    const auto matrixOf = [&](const Place& place) {
        return clusterMatrix(rowsOf(source.sets[place.set]->transport), place.first, place.count,
                             made[place.set].kinds, source.spectrum, source.units[place.set]);
    };

    // The rows are read twice (kLayoutPasses): once for what each cluster asks for, once for what it gets.
    std::vector<BasisAnalysis> analyses(places.size());
    passes.run(places, [&](size_t i) { analyses[i] = analyse(matrixOf(places[i])); });
    const double price = options.bytesPerVertex ? priceForBytes(analyses, budget)
                                                : priceForError(analyses, source.squared(options.error));
    std::vector<double> errors(places.size());
    passes.run(places, [&](size_t i) {
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

Conversion convertLayout(Asset& asset, const LayoutOptions& options, const Report& progress,
                         std::optional<int> coefficients) {
    sumAlikeEverywhere();
    const std::vector<MaterialSet*> sets = setsOf(asset);
    const bool areRows = std::ranges::all_of(
        sets, [](const MaterialSet* set) { return layoutOf(set->transport) == TransportLayout::Rows; });
    const bool areShorter = coefficients && *coefficients < asset.coefficients;
    const bool needsRows = areShorter || !areRows, isLast = options.layout == TransportLayout::Rows;
    Passes passes(sets, (needsRows ? 1 : 0) + (isLast ? 0 : kLayoutPasses), progress);
    Conversion conversion;
    conversion.bytesBefore = bytesOf(sets);
    if (areShorter) asset.coefficients = *coefficients;
    if (needsRows) makeRows(sets, asset, passes);
    if (!isLast) {
        const Source source(sets, asset.faceSize);
        const double budget = options.bytesPerVertex.value_or(0) * double(verticesOf(asset));
        conversion.error = convertToBases(source, options, budget, passes);
        if (!std::isfinite(*conversion.error)) throw Error(kTooLarge);
        // What was lost before is lost: about independent of what is lost now, so that squares add.
        const double before = asset.layout ? asset.layout->error : 0;
        asset.layout = recordOf(options, std::hypot(before, *conversion.error));
    }
    conversion.bytesAfter = bytesOf(sets);
    return conversion;
}

} // namespace relume
