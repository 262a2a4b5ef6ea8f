#include "precompute/layout/layout_scale.h"

#include "precompute/layout/basis_kinds.h"
#include "precompute/layout/light_spectrum.h"
#include "precompute/layout/same_sums.h"
#include "precompute/layout/slope.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// A cluster of a sample, and how many it stands for.
struct Place {
    uint32_t sample;
    const SparseTransport* rows;
    uint32_t first, count;
    double weight;
};

uint64_t sampledOf(const SetSample& sample) {
    uint64_t vertices = 0;
    for (const SparseTransport* rows : sample.blocks) vertices += rows->vertices;
    return vertices;
}

std::vector<Place> placesOf(std::span<const SetSample> samples) {
    std::vector<Place> places;
    for (uint32_t number = 0; number < samples.size(); number++) {
        const double weight = double(samples[number].vertices) / double(sampledOf(samples[number]));
        for (const SparseTransport* rows : samples[number].blocks)
            for (uint32_t first = 0; first < rows->vertices; first += kBasisVertices)
                places.push_back(
                    {number, rows, first, std::min(kBasisVertices, rows->vertices - first), weight});
    }
    return places;
}

} // namespace

LayoutScale findScale(std::span<const SetSample> samples, int faceSize, uint64_t vertices,
                      const LayoutOptions& options) {
    sumAlikeEverywhere();
    const std::vector<float> spectrum = lightSpectrum(faceSize);
    LayoutScale scale;
    double error = 0;                 // wanted, squared
    double allRows = 0, toldRows = 0; // of sets that the samples tell of
    for (const SetSample& sample : samples) {
        scale.units.push_back(sample.unit);
        const double rows = double(sample.vertices) * sample.set->brdf.terms;
        allRows += rows;
        if (sampledOf(sample) == 0) continue;
        toldRows += rows;
        error += options.error * options.error * double(sample.vertices);
    }
    const double share = allRows > 0 ? toldRows / allRows : 1;
    const double budget = share * options.bytesPerVertex.value_or(0) * double(vertices);
    const std::vector<Place> places = placesOf(samples);
    std::vector<BasisAnalysis> analyses(places.size());
    tbb::parallel_for(size_t(0), places.size(), [&](size_t i) {
        const Place& place = places[i];
        const SetSample& sample = samples[place.sample];
        analyses[i] =
            analyse(clusterMatrix(*place.rows, place.first, place.count, basisKinds(sample.set->brdf),
                                  spectrum, scale.units[place.sample]));
        analyses[i].weight = place.weight;
    });
    scale.price = options.bytesPerVertex ? priceForBytes(analyses, budget) : priceForError(analyses, error);
    return scale;
}

LayoutRecord recordOf(const LayoutOptions& options, double error) {
    LayoutRecord record;
    record.wantedBytes = options.bytesPerVertex;
    if (!options.bytesPerVertex) record.wantedError = options.error;
    record.error = error;
    return record;
}

} // namespace relume
