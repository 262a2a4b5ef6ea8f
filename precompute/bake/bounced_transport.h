// Bounced light, as transport that is added to directly baked rows.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/bake/block_baker.h"

#include <limits>

namespace relume {

// Raised whenever bounced light, or what errors are relative to with it, comes out differently, which
// invalidates older checkpoints and shards.
constexpr uint32_t kBouncesVersion = 10;

// Rows of bounced light per part and set.
class BouncedTransport {
  public:
    // Takes rows per part and set, as BounceGather::gather() returns them.
    explicit BouncedTransport(std::vector<std::vector<SparseTransport>> rows) : mRows(std::move(rows)) {}

    // Adds bounced light to `sets`, the rows per set of a part's vertices from `first` on. Rows keep their
    // rowEntries() largest entries, or `most` if that is less; what that loses is added to their losses.
    void addTo(std::span<BakedRows> sets, const Asset& asset, size_t part, uint32_t first,
               int most = std::numeric_limits<int>::max()) const;

    // Adds the bounced light of one row to all its coefficients.
    void addTo(std::span<vec3> coefficients, size_t part, size_t set, size_t row, int faceSize) const;

    const SparseTransport& rows(size_t part, size_t set) const { return mRows[part][set]; }

  private:
    std::vector<std::vector<SparseTransport>> mRows; // coefficients of a cube of kBounceFaceSize
};

// Returns an upper bound on the host memory, in bytes, that rows take while bounces are computed.
uint64_t bounceBytes(const Asset& asset, const Appearance& appearance);

// Computes the bounces that the plan's options ask for, with every part in its default appearance (its first
// material, or as painted). Direct transport is first baked at a low resolution as the source. Stores the
// shares of direct light in the sets of `plan` (MaterialSet::directShares). If `lastSources` is given, it
// receives the transport from which the last bounce was gathered. Throws BakeStopped, and Error if the
// machine has less memory than bounceBytes() or baking fails; `plan`, whose occluder is moved out meanwhile,
// is then unusable.
std::shared_ptr<const BouncedTransport> bounceTransport(const vk::Device& device, BakePlan& plan,
                                                        const BakeLimits& limits, BakeObserver& observer,
                                                        BakeTimes& times,
                                                        std::vector<SparseTransport>* lastSources = nullptr);

// Recomputes the bounced light of a baked asset, which must have at least one bounce. Throws as above.
std::shared_ptr<const BouncedTransport>
bouncedTransportOf(const vk::Device& device, const Asset& asset, BakeObserver& observer,
                   std::vector<SparseTransport>* lastSources = nullptr);

} // namespace relume
