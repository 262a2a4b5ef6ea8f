// Light that reaches vertices by way of other surfaces, as transport to be added to what was baked.
#pragma once

#include "engine/render/appearance.h"
#include "precompute/bake/block_baker.h"

namespace relume {

// The version is raised when bounced light comes out differently: checkpoints and shards of before do not
// fit.
constexpr uint32_t kBouncesVersion = 3;

// Rows of bounced light, which are added to blocks as they are baked.
class BouncedTransport {
  public:
    // Takes rows per part and set, as BounceGather gives them.
    explicit BouncedTransport(std::vector<std::vector<SparseTransport>> rows) : mRows(std::move(rows)) {}

    // Adds them to the rows of a part's vertices from `first` on, per set. Rows keep their `kept` largest
    // coefficients; what is lost by that is added to their losses.
    void addTo(std::span<BakedRows> sets, size_t part, uint32_t first, int faceSize, int kept) const;

    // Adds one to all coefficients of a row of a set.
    void addTo(std::span<vec3> coefficients, size_t part, size_t set, size_t row, int faceSize) const;

    const SparseTransport& rows(size_t part, size_t set) const { return mRows[part][set]; }

  private:
    std::vector<std::vector<SparseTransport>> mRows; // of kBounceFaceSize
};

// Returns the most bytes of host memory that rows take while light bounces.
uint64_t bounceBytes(const Asset& asset, const Appearance& bound);

// Finds the light of as many bounces as the plan's options have, of the parts in the first material of each,
// or as they are painted. Direct transport is baked for it at a low resolution. Throws BakeStopped, and Error
// where there is less memory than bounceBytes() or what a bake throws; then nothing more can be baked of
// `plan`, whose occluder is borrowed. `lastSources`, if any: what the last bounce was gathered from.
std::shared_ptr<const BouncedTransport> bounceTransport(const vk::Device& device, BakePlan& plan,
                                                        const BakeLimits& limits, BakeObserver& observer,
                                                        BakeTimes& times,
                                                        std::vector<SparseTransport>* lastSources = nullptr);

// Finds again the bounced light that an asset was baked with, at least one bounce. Throws as above.
std::shared_ptr<const BouncedTransport>
bouncedTransportOf(const vk::Device& device, const Asset& asset, BakeObserver& observer,
                   std::vector<SparseTransport>* lastSources = nullptr);

} // namespace relume
