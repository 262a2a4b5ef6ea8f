// What the stages of a bake must move: the floor that memory puts under them.
#pragma once

#include "apps/relume/bake_bench.h"

namespace relume {

// Bytes that a stage reads and writes per vertex, each once, by the sizes of the buffers between stages and
// as if nothing were skipped; nothing for stages that move next to none. Means over a sample.
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
