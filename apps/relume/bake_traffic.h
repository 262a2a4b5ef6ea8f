// The memory traffic of a bake's stages, a lower bound on their time.
#pragma once

#include "apps/relume/bake_bench.h"

namespace relume {

// Bytes per vertex that a stage reads and writes, each once, from the sizes of the buffers between stages and
// as if nothing were skipped; none for stages with negligible traffic. Means over a sample.
class BakeTraffic {
  public:
    BakeTraffic(const BakeSample& sample, const BakeOptions& options, double raysPerVertex,
                double trianglesPerVertex);

    std::optional<double> cpu(const std::string& stage) const;    // stages of CpuPath
    std::optional<double> device(const std::string& stage) const; // stages of DevicePath

  private:
    double mRays, mTriangles;
    double mTexels;              // of the visibility cube
    double mCoefficients, mKept; // of all terms
};

} // namespace relume
