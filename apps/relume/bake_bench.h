// A sample of a scene's vertices, and the ways to bake it.
#pragma once

#include "engine/import/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/commands.h"
#include "precompute/bake/bake_options.h"

#include <memory>

namespace relume {

struct BakeSample {
    Asset asset;                                        // ordered and factored; its rows are empty
    std::vector<std::vector<shared::BakePoint>> points; // per part

    uint64_t vertices() const;
    uint64_t sampled() const;
    double termsPerVertex() const; // mean over the sample
};

// About `vertices` vertices, of every part in proportion: runs of 64 neighbors, as bakes take them, spread
// evenly through the bake order.
BakeSample sampleBake(const vk::Device& device, Scene scene, const BakeOptions& options, uint64_t vertices);

// Rows of the sample: per part and set.
using SampleRows = std::vector<std::vector<SparseTransport>>;

// sqrt(Σ|a - b|² / Σ|b|²) over the decoded rows of two bakes of one sample.
double relativeDifference(const SampleRows& a, const SampleRows& b, int faceSize);

// One run over the whole sample.
struct SampleRun {
    double seconds = 0;   // wall clock
    vk::PassTimes stages; // seconds; they add up to about `seconds`
    SampleRows rows;
};

// A way to bake the sample; made once, run many times. Refers to its sample.
class BakePath {
  public:
    virtual ~BakePath() = default;
    virtual SampleRun run() = 0;
};

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

// As the traced DevicePath, from visibility as a file keeps it: found once, before the first run.
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

// Triangles that RasterVisibility draws for the whole sample, over all cube faces.
uint64_t countDrawnTriangles(const vk::Device& device, const BakeSample& sample, const BakeOptions& options);

} // namespace relume
