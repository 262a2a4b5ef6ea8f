// A sample of a scene's vertices, and several ways to bake it.
#pragma once

#include "engine/import/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_options.h"

#include <memory>

namespace relume {

struct BakeSample {
    Asset asset;                                        // in bake order and factored; without rows
    std::vector<std::vector<shared::BakePoint>> points; // per part

    uint64_t vertices() const;
    uint64_t sampled() const;
    double termsPerVertex() const; // mean over the sample
};

// Samples about `vertices` vertices from all parts in proportion: runs of 64 neighbors, as in bakes, spread
// evenly through the bake order.
BakeSample sampleBake(const vk::Device& device, Scene scene, const BakeOptions& options, uint64_t vertices);

// Rows of the sample, per part and set.
using SampleRows = std::vector<std::vector<SparseTransport>>;

// Returns sqrt(Σ|a - b|² / Σ|b|²) over the decoded rows of two bakes of one sample.
double relativeDifference(const SampleRows& a, const SampleRows& b, int faceSize);

// One bake of the whole sample.
struct SampleRun {
    double seconds = 0;   // wall clock
    vk::PassTimes stages; // seconds; they add up to about `seconds`
    SampleRows rows;
};

// A way to bake the sample, made once and run many times. Keeps a reference to the sample.
class BakePath {
  public:
    virtual ~BakePath() = default;
    virtual SampleRun run() = 0;
};

// Bakes on the CPU with CpuBaker.
class CpuPath : public BakePath {
  public:
    CpuPath(const BakeSample& sample, const BakeOptions& options);
    ~CpuPath() override;
    SampleRun run() override;

    uint64_t rays() const { return mRays; } // of the last run

  private:
    struct Part;
    const BakeSample& mSample;
    std::vector<Part> mParts;
    uint64_t mRays = 0;
};

// Bakes on the device, with visibility by the given method.
class DevicePath : public BakePath {
  public:
    DevicePath(const vk::Device& device, const BakeSample& sample, const BakeOptions& options,
               VisibilityMethod method);
    ~DevicePath() override;
    SampleRun run() override;

  private:
    struct Part;
    const BakeSample& mSample;
    std::vector<Part> mParts;
};

// Bakes on the device with visibility kept as in a file, which is computed once, before the first run.
class RebakePath : public BakePath {
  public:
    RebakePath(const vk::Device& device, const BakeSample& sample, const BakeOptions& options);
    ~RebakePath() override;
    SampleRun run() override;

  private:
    struct Part;
    const BakeSample& mSample;
    BakeOptions mOptions;
    std::vector<Part> mParts;
};

// Returns the number of triangles that RasterVisibility draws for the whole sample, over all cube faces.
uint64_t countDrawnTriangles(const vk::Device& device, const BakeSample& sample, const BakeOptions& options);

// The memory traffic of a bake's stages, a lower bound on their time: bytes per vertex that a stage reads and
// writes, each once, from the sizes of the buffers between stages and as if nothing were skipped; none for
// stages with negligible traffic. Means over a sample.
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
