// A progressive version of renderReference(): an image by sampling that improves with every pass.
#pragma once

#include "engine/image/image.h"
#include "engine/render/ground_fade.h"
#include "engine/scene/camera.h"
#include "precompute/reference/bound_asset.h"
#include "precompute/reference/light_distribution.h"

#include <array>
#include <span>
#include <stop_token>

namespace relume {

// Statistical estimate of an image's error, over all covered pixels and channels.
struct ReferenceError {
    // RMS error of the image against the truth: √ mean((A - image)(B - image)), where A and B are the means
    // of the even and the odd passes. Their noise is independent, so the mean is free of it; it can be
    // negative if the error is small against the noise, which gives 0.
    double rmse = 0;
    // RMS of the truth itself, √ mean(A B), likewise.
    double level = 0;
    // Standard error of mean() against the truth, from the difference of A and B: √ mean((A - B)²) / 2 after
    // as many even as odd passes.
    double noise = 0;
    // Standard error of the alpha of mean(): that of a ground's shadow.
    double alphaNoise = 0;
    // rmse² before it is clamped at 0, and its standard error due to the reference's noise: pixels are
    // independent, and (|A - image|² - |B - image|²) / 2 of a pixel has the variance of its product if noise
    // is normally distributed.
    double square = 0, squareNoise = 0;
};

// Converges to renderReference() under a light cube with the full mesh as occluder, for large
// raysPerTexelSide: light is constant over each texel; surfaces, frames and shadow offset are the same. Not
// thread-safe.
class ProgressiveReference {
  public:
    // Keeps a reference to `asset` and builds its acceleration structure. Light bounces up to `bounces`
    // times, by default as often as in the asset, and only with the exact BRDF. Throws Error if Embree fails.
    explicit ProgressiveReference(const Asset& asset, ReferenceBrdf brdf = ReferenceBrdf::Exact,
                                  std::optional<int> bounces = {});

    // Starts a new image with `samples` per pixel, 1, 2, 4 or 8 as in the view pass. Hits are kept if camera
    // and size are unchanged, BRDFs always. A ground with a fade has the style that the fade says. Throws as
    // makeBrdf() does; after that, passes need another restart.
    void restart(const Camera& camera, const LightCube& light, const Appearance& appearance, int width,
                 int height, int samples, const std::optional<GroundFade>& ground = std::nullopt);

    // Adds one ray per pixel, through one of its samples, on all cores; the result depends only on the number
    // of the pass. The first pass also finds the hits. Returns false if stopped, which discards the pass.
    bool addPass(std::stop_token stop = {});

    // Returns the number of passes since the restart.
    int passes() const { return mPasses; }

    // Returns linear radiance, premultiplied by alpha, the share of a pixel's samples that hit a surface,
    // less where a ground fades or shows its shadow alone. Zero before the first pass. Negative means, which
    // factors can have, are clamped at 0.
    Image mean() const;

    // Returns the means of the even and the odd passes, whose noise is independent. Needs two passes.
    std::array<Image, 2> halves() const;

    // Returns the error of an image of this size, ignoring its alpha and pixels of nothing but a ground's
    // shadow; none before the second pass or if nothing is visible.
    std::optional<ReferenceError> errorOf(const Image& image) const;

  private:
    void findSurfaces(int y);
    void sampleRow(int y);
    // Returns the sample of a pixel that the current pass uses.
    size_t sampleOf(size_t pixel) const;
    std::span<const std::optional<RayHit>> surfacesOf(size_t pixel) const {
        return std::span(mSurfaces).subspan(pixel * mSamples, mSamples);
    }
    // Returns how much of a ground is seen at a hit: 1 without a fade, and for other parts.
    float groundCoverageAt(const RayHit& hit, vec3 position) const;
    bool isShadow(const RayHit& hit) const {
        return mGround && mGround->isShadow && mGround->part == hit.mesh;
    }
    // `groundLight`: of mGroundLight, for a ground's shadow.
    float coverageOf(size_t pixel, vec2 groundLight) const;
    // Makes an image of the radiance of covered pixels, clamped at 0.
    template <typename Value>
    Image imageOf(const Value& valueOf, const std::vector<vec2>& groundLight) const;

    const Asset& mAsset;
    ReferenceBrdf mKind;
    int mBounces;
    std::vector<const Mesh*> mMeshes; // per part
    RayTracer mTracer;                // one mesh per part; finds hits and shadows
    float mShadowOffset;
    MaterialBrdfs mBrdfs;

    Camera mCamera;
    int mWidth = 0, mHeight = 0;
    size_t mSamples = 1; // per pixel
    std::optional<BoundAsset> mBound;
    std::optional<LightDistribution> mLight;
    std::optional<GroundFade> mGround;
    int mPasses = 0;
    std::vector<uint8_t> mRowsSeen;                 // per row: whether its hits are known
    std::vector<std::optional<RayHit>> mSurfaces;   // per pixel and sample: hit
    std::vector<vec3> mSample;                      // per pixel: of the current pass
    std::array<std::vector<glm::dvec3>, 2> mHalves; // per pixel: sums of the even and the odd passes
    // Per pixel, for a ground's shadow: the ground's luminance and what it would be unshadowed, of the
    // current pass, and sums over the even and the odd passes.
    std::vector<vec2> mGroundSample;
    std::array<std::vector<vec2>, 2> mGroundLight;
    std::unique_ptr<RayTracer>
        mWithoutGround; // of the other parts, if the ground is hidden from the eye; else null
};

} // namespace relume
