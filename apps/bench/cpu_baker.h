// A bake of vertices on the CPU, as fast as possible: the yardstick for the device's paths (relume bench
// bake). The naive twins in precompute/twins define its results.
#pragma once

#include "apps/bench/cpu_rows.h"
#include "engine/transport/asset.h"
#include "precompute/bake/bake_options.h"
#include "precompute/cpu/cpu_visibility.h"
#include "shaders/shared/bake.h"

namespace relume {

// Seconds, summed over all threads, and the number of rays.
struct CpuBakeTimes {
    double visibility = 0, transport = 0, haar = 0, pack = 0;
    uint64_t rays = 0;

    CpuBakeTimes& operator+=(const CpuBakeTimes& other);
};

class CpuBaker {
  public:
    // Takes a part with factored sets, of an asset with an occluder.
    CpuBaker(const Asset& asset, const AssetPart& part, const BakeOptions& options);

    // Bakes any number of points on all threads, as PartPasses::bake() does: appends rows to `transports`,
    // one per set, and adds to `losses`. The result does not depend on the number of threads.
    void bake(std::span<const shared::BakePoint> points, std::span<SparseTransport* const> transports,
              TransportLosses& losses);

    const CpuBakeTimes& times() const { return mTimes; }

  private:
    CpuVisibility mVisibility;
    std::vector<int> mSetTerms;
    CpuTransport mTransport;
    int mKept;
    CpuBakeTimes mTimes;
};

} // namespace relume
