// A reference image that is there at once and gets better: renderReference() by sampling.
#pragma once

#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"

#include <array>
#include <span>
#include <stop_token>

namespace relume {

// What a progressive reference knows of an image's error, of all covered pixels and channels.
struct ReferenceError {
    // Of the image against the truth: √ mean((A - image)(B - image)), A and B the means of the even and the
    // odd passes. Their noise is independent, so that the mean of products is that of squared errors,
    // whatever the noise; it may come out below zero where the error is small against the noise, and 0 stands
    // for that.
    double rmse = 0;
    // Of the truth itself, √ mean(A B): what an error is relative to. 0 as above.
    double level = 0;
    // Standard error of mean() against the truth, from how A and B differ: √ mean((A - B)²) / 2 after as many
    // even as odd passes.
    double noise = 0;
    // Of rmse² before it is held at 0, and that estimate's standard error, of the reference's noise alone:
    // pixels' noise is independent, and (|A - image|² - |B - image|²) / 2 of a pixel has the variance of its
    // product, were noise normally distributed.
    double square = 0, squareNoise = 0;
};

// Converges to renderReference() under a light cube, full mesh as occluder, as raysPerTexelSide grows: light
// constant over each texel, the same surfaces, frames and shadow offset. One caller at a time.
class ProgressiveReference {
  public:
    // Builds the scene for rays. Refers to `asset`. Light bounces between surfaces up to `bounces` times, or
    // as often as the asset's does; with the exact BRDF alone. Throws Error when Embree fails.
    explicit ProgressiveReference(const Asset& asset, ReferenceBrdf brdf = ReferenceBrdf::Exact,
                                  std::optional<int> bounces = {});

    // Forgets what was summed. What is needed anew is made anew: surfaces stay as long as camera and size do,
    // BRDFs always. `samples`: of a pixel, as the view pass has them, 1, 2, 4 or 8. Throws as makeBrdf()
    // does; no pass may follow then until a restart succeeds.
    void restart(const Camera& camera, const LightCube& light, const Appearance& appearance, int width,
                 int height, int samples);

    // One more ray of every pixel, through one of its samples, on all cores; what it gives depends on its
    // number alone. The first pass finds the surfaces, too. False if stopped: between rows, and then the pass
    // counts for nothing.
    bool addPass(std::stop_token stop = {});

    // Since the restart.
    int passes() const { return mPasses; }

    // Linear radiance, premultiplied by alpha: the share of a pixel's samples that see a surface. All zero
    // before the first pass. Factors can be negative, the mean is not.
    Image mean() const;

    // The means of the even and of the odd passes, likewise: their noise is independent. After two passes.
    std::array<Image, 2> halves() const;

    // Of an image of this size; its alpha does not count. None before the second pass, or if nothing is seen.
    std::optional<ReferenceError> errorOf(const Image& image) const;

  private:
    void findSurfaces(int y);
    void sampleRow(int y);
    // The sample of a pixel that the current pass takes.
    size_t sampleOf(size_t pixel) const;
    std::span<const std::optional<RayHit>> surfacesOf(size_t pixel) const {
        return std::span(mSurfaces).subspan(pixel * mSamples, mSamples);
    }
    float coverageOf(size_t pixel) const;
    // Radiance of every covered pixel, held at 0.
    template <typename Value>
    Image imageOf(const Value& valueOf) const;

    const Asset& mAsset;
    ReferenceBrdf mKind;
    int mBounces;
    std::vector<const Mesh*> mMeshes; // of the parts
    RayTracer mTracer;                // one mesh per part: what is seen, and what casts shadows
    float mShadowOffset;
    MaterialBrdfs mBrdfs;

    Camera mCamera;
    int mWidth = 0, mHeight = 0;
    size_t mSamples = 1; // a pixel
    std::optional<BoundAsset> mBound;
    std::optional<LightDistribution> mLight;
    int mPasses = 0;
    std::vector<uint8_t> mRowsSeen;                 // per row: whether its surfaces are found
    std::vector<std::optional<RayHit>> mSurfaces;   // per sample of each pixel
    std::vector<vec3> mSample;                      // per pixel: of the pass under way
    std::array<std::vector<glm::dvec3>, 2> mHalves; // per pixel: sums of the even and of the odd passes
};

} // namespace relume
