// The inputs of layouts' encoders, during a bake or a conversion.
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

// A sample of a set's vertices.
struct SetSample {
    const MaterialSet* set;
    std::vector<const SparseTransport*> blocks; // rows of whole clusters, except that the last may be partial
    uint32_t vertices;                          // of the whole set
    float norm;                                 // normalization: transportNorm() of the set
    bool isBounced = false;                     // whether the rows include light of other surfaces

    uint64_t sampledVertices() const {
        uint64_t sampled = 0;
        for (const SparseTransport* rows : blocks) sampled += rows->vertices;
        return sampled;
    }
};

// The total that is wanted: bytes in memory, or a squared error relative to the sets' normalization.
struct LayoutTarget {
    std::optional<double> bytes;
    double error;
};

// The parameters for encoding one block.
struct BlockCoding {
    uint32_t first, run; // first vertex in the set, and run of the chunk
    int faceSize;
    float norm; // transportNorm() of the set
    double lambda;
    std::string where; // names the block in errors
};

// A block's chunk before compression, and its squared error relative to the set's normalization.
struct EncodedBlock {
    std::vector<std::byte> bytes;
    double error = 0;
};

// Sets in rows to be converted, and the weights of their errors.
struct RowSource {
    std::vector<MaterialSet*> sets;
    std::vector<float> spectrum; // lightSpectrum()
    std::vector<float> norms;    // per set: transportNorm()
    bool isBounced = false;
};

// A range of vertices of a set.
struct SetPlace {
    uint32_t set, first, count;
};
// Returns ranges of at most `vertices` that cover all sets.
inline std::vector<SetPlace> placesOf(std::span<MaterialSet* const> sets, uint32_t vertices) {
    std::vector<SetPlace> places;
    for (uint32_t set = 0; set < sets.size(); set++) {
        const uint32_t all = verticesOf(sets[set]->transport);
        for (uint32_t first = 0; first < all; first += vertices)
            places.push_back({set, first, std::min(vertices, all - first)});
    }
    return places;
}

// Called with the number of vertices done and the total, over all sets.
using ConversionReport = std::function<void(uint64_t done, uint64_t total)>;

constexpr uint64_t kConversionPasses = 2; // passes that convertRows() makes over the rows

// Runs passes over ranges of vertices and reports progress.
class ConversionPasses {
  public:
    ConversionPasses(std::span<MaterialSet* const> sets, uint64_t passes, const ConversionReport& report)
        : mPasses(passes), mReport(report) {
        for (const MaterialSet* set : sets) mVertices += verticesOf(set->transport);
    }

    // Runs work(i) for all places in parallel.
    template <typename Work>
    void run(std::span<const SetPlace> places, const Work& work) {
        constexpr uint64_t kBatchVertices = 8192; // between two reports
        uint64_t vertices = 0;                    // of a batch
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
