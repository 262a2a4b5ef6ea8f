// A bake of vertices without a GPU, as fast as a CPU does it: the yardstick that the device's paths are held
// against (relume bench bake). The naive twins in precompute/reference say what it must compute.
#pragma once

#include "apps/bench/cpu_rows.h"
#include "engine/transport/asset.h"
#include "precompute/bake/bake_options.h"
#include "precompute/cpu/cpu_visibility.h"
#include "shaders/shared/bake.h"

namespace relume {

// Seconds of all threads together, and rays.
struct CpuBakeTimes {
    double visibility = 0, transport = 0, haar = 0, pack = 0;
    uint64_t rays = 0;

    CpuBakeTimes& operator+=(const CpuBakeTimes& other);
};

class CpuBaker {
  public:
    // For a part whose sets are factored, of an asset whose occluder is made.
    CpuBaker(const Asset& asset, const AssetPart& part, const BakeOptions& options);

    // Bakes any number of points on all threads, as PartPasses::bake does: appends their rows to
    // `transports`, one per set, and adds up `losses`. The same for any number of threads.
    void bake(std::span<const shared::BakePoint> points, std::span<SparseTransport* const> transports,
              TransportLosses& losses);

    const CpuBakeTimes& times() const { return mTimes; }
    static int threads(); // that bake() uses

  private:
    CpuVisibility mVisibility;
    std::vector<int> mSetTerms;
    CpuTransport mTransport;
    int mKept;
    CpuBakeTimes mTimes;
};

} // namespace relume
