// Gathers one bounce of light: the transport of every vertex by way of the surfaces that it sees.
//
// For vertex x, term k and each direction ω in which x sees a point y of another surface:
//
//     T'[x, k] = ∫ g_k(ω) cosθ · Σ_m h_m(−ω at y) T[y, m] dω,
//
// where T are the rows at y of the material that lights others, and g and h are light and view maps
// (docs/bounces.md). All of it is linear in the lighting, so bounced rows are added to the directly baked
// ones.
#pragma once

#include "engine/transport/rows/sparse_transport.h"
#include "precompute/bounce/bounce_hits.h"

namespace relume {

// Bounced light has a lower resolution than the lighting cube: texels per side of a face.
constexpr int kBounceFaceSize = 16;
constexpr int kBounceCoefficients = 6 * kBounceFaceSize * kBounceFaceSize;

// Returns the most entries of a row of bounced light to a part that has so many terms in all its sets, or of
// a row of its source, a set of so many terms. They are most of what a bake with bounces holds in memory.
constexpr int bounceEntries(int terms) { return (terms == 1 ? kOneTermEntries : 1) * 192; }

// Returns the index in a cube of kBounceFaceSize of a coefficient (face · size² + y · size + x) of a larger
// cube, or nothing if it is too fine. The Haar basis is nested: the coefficients of a cube of n texels per
// side are the first n × n of every face of the larger one, times size / n.
std::optional<uint16_t> bounceCoefficient(uint16_t coefficient, int size);
// Returns the index in a cube of `size` texels per side of a coefficient of kBounceFaceSize.
uint16_t coefficientOfBounce(uint16_t coefficient, int size);

// Returns the coefficients of rows of a larger cube that exist at kBounceFaceSize.
SparseTransport bounceRows(const SparseTransport& rows, int faceSize);

// Returns rows of no vertices for each set of a part.
std::vector<SparseTransport> emptyBouncedRows(const AssetPart& part);

// Called with the number of vertices done; returns whether to go on.
using BounceReport = std::function<bool(uint64_t vertices)>;

// Gathers bounced light for all vertices of an asset, on the CPU. Device twin: BounceGatherPass.
class BounceGather {
  public:
    // Keeps a reference to `hits`.
    explicit BounceGather(const BounceHits& hits) : mHits(hits) {}

    // Gathers rows per part and set, from the rows of the bound sets, `from`, one per part; all are
    // coefficients of kBounceFaceSize. The result does not depend on the number of threads. Returns nothing
    // if stopped.
    std::vector<std::vector<SparseTransport>> gather(std::span<const SparseTransport> from,
                                                     const BounceReport& report) const;

  private:
    struct Room;
    void gatherVertex(size_t part, uint32_t vertex, std::span<const SparseTransport> from, Room& room,
                      std::span<SparseTransport> rows) const;

    const BounceHits& mHits;
};

} // namespace relume
