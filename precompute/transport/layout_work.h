// What layouts are given to work on when a bake or a conversion encodes transport.
#pragma once

#include "engine/transport/asset.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <tbb/parallel_for.h>
#include <vector>

namespace relume {

// Vertices of a set that stand for all of them.
struct SetSample {
    const MaterialSet* set;
    std::vector<const SparseTransport*> blocks; // each of clusters, of which only the last may not be full
    uint32_t vertices;                          // of the whole set
    float unit;                                 // transportUnit() of the set
    bool isBounced = false;                     // whether the rows have light of other surfaces, too

    uint64_t sampledVertices() const {
        uint64_t sampled = 0;
        for (const SparseTransport* rows : blocks) sampled += rows->vertices;
        return sampled;
    }
};

// What is asked for in all: bytes in memory, or an error, squared and in units of the sets.
struct LayoutTarget {
    std::optional<double> bytes;
    double error;
};

// How a block is encoded by itself.
struct BlockCoding {
    uint32_t first, run; // its first vertex in the set, and the run of its chunk
    int faceSize;
    float unit; // transportUnit() of the set
    double price;
    std::string where; // names the block in errors
};

// A block's chunk before compression, and its squared error in units of the set.
struct EncodedBlock {
    std::vector<std::byte> bytes;
    double error = 0;
};

// Sets in rows that are converted, and what weighs their errors.
struct RowSource {
    std::vector<MaterialSet*> sets;
    std::vector<float> spectrum; // lightSpectrum()
    std::vector<float> units;    // per set: transportUnit()
    bool isBounced = false;
};

// Vertices of a set.
struct SetPlace {
    uint32_t set, first, count;
};
// Those of all sets, so many each.
inline std::vector<SetPlace> placesOf(std::span<MaterialSet* const> sets, uint32_t vertices) {
    std::vector<SetPlace> places;
    for (uint32_t set = 0; set < sets.size(); set++) {
        const uint32_t all = verticesOf(sets[set]->transport);
        for (uint32_t first = 0; first < all; first += vertices)
            places.push_back({set, first, std::min(vertices, all - first)});
    }
    return places;
}

// Told how many vertices of all sets are done, of how many.
using ConversionReport = std::function<void(uint64_t done, uint64_t total)>;

constexpr uint64_t kConversionPasses = 2; // that convertRows() makes over the rows

// Tells how far passes over all places are.
class ConversionPasses {
  public:
    ConversionPasses(std::span<MaterialSet* const> sets, uint64_t passes, const ConversionReport& report)
        : mPasses(passes), mReport(report) {
        for (const MaterialSet* set : sets) mVertices += verticesOf(set->transport);
    }

    // Runs work(i) for all places, in parallel.
    template <typename Work>
    void run(std::span<const SetPlace> places, const Work& work) {
        constexpr uint64_t kBatchVertices = 8192; // between two reports
        uint64_t vertices = 0;                    // in a batch
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
    const ConversionReport& mReport;
};

} // namespace relume
