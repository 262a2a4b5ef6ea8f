#include "precompute/reference/progressive_reference.h"

#include "engine/base/check.h"
#include "engine/math/color.h"
#include "engine/transport/asset_check.h"
#include "precompute/reference/path_sampling.h"
#include "precompute/reference/pixel_hits.h"
#include "precompute/reference/reference_image.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

bool isSame(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.target == b.target && a.verticalFov == b.verticalFov;
}

} // namespace

ProgressiveReference::ProgressiveReference(const Asset& asset, ReferenceBrdf brdf, std::optional<int> bounces)
    : mAsset(asset), mKind(brdf), mBounces(bounces.value_or(asset.bounces)), mMeshes(partMeshes(asset)),
      mTracer(mMeshes), mShadowOffset(kFullMeshShadowOffset * boundsOf(asset).radius()) {}

void ProgressiveReference::restart(const Camera& camera, const LightCube& light, const Appearance& appearance,
                                   int width, int height, int samples,
                                   const std::optional<GroundFade>& ground) {
    RELUME_CHECK(width > 0 && height > 0);
    expectSamples(samples);
    const size_t pixels = size_t(width) * size_t(height);
    mPasses = 0;
    mBound.reset();
    mLight.emplace(light);
    mGround = ground;
    mGroundSample.assign(ground && ground->isShadow ? pixels : 0, vec2(0));
    mGroundLight = {mGroundSample, mGroundSample};
    const bool wasHidden = mWithoutGround != nullptr;
    mWithoutGround = tracerWithout(ground, camera.eye, mMeshes);
    if (width != mWidth || height != mHeight || size_t(samples) != mSamples || !isSame(camera, mCamera) ||
        mWithoutGround || wasHidden) {
        mCamera = camera, mWidth = width, mHeight = height, mSamples = size_t(samples);
        mRowsSeen.assign(size_t(height), false);
        mSurfaces.assign(pixels * mSamples, std::nullopt);
    }
    for (auto& half : mHalves) half.assign(pixels, glm::dvec3(0));
    mSample.resize(pixels);
    mBound.emplace(mAsset, appearance, mKind, mBrdfs);
}

void ProgressiveReference::findSurfaces(int y) {
    if (mRowsSeen[size_t(y)]) return;
    for (int x = 0; x < mWidth; x++)
        findPixelHits(
            mWithoutGround ? *mWithoutGround : mTracer, mCamera, {x, y}, {mWidth, mHeight},
            std::span(mSurfaces).subspan((size_t(y) * size_t(mWidth) + size_t(x)) * mSamples, mSamples));
    mRowsSeen[size_t(y)] = true;
}

// A pixel's even passes cycle through its samples, and so do its odd passes, each from a random start, so
// that neither half's mean favors some samples.
size_t ProgressiveReference::sampleOf(size_t pixel) const {
    if (mSamples == 1) return 0;
    HashedNumbers random{uint32_t(pixel), ~uint32_t(mPasses % 2)};
    return (size_t(random.next() * float(mSamples)) + size_t(mPasses / 2)) % mSamples;
}

float ProgressiveReference::groundCoverageAt(const RayHit& hit, vec3 position) const {
    return mGround && mGround->part == hit.mesh ? groundCoverage(*mGround, position) : 1;
}

float ProgressiveReference::coverageOf(size_t pixel, vec2 groundLight) const {
    float covered = 0;
    for (const std::optional<RayHit>& hit : surfacesOf(pixel)) {
        if (!hit) continue;
        float share = mGround ? groundCoverageAt(*hit, mBound->pointAt(*hit, mCamera.eye).position) : 1;
        if (isShadow(*hit)) share *= shadowAlpha(vec3(groundLight.x), vec3(groundLight.y));
        covered += share;
    }
    return covered / float(mSamples);
}

void ProgressiveReference::sampleRow(int y) {
    const size_t first = size_t(y) * size_t(mWidth);
    for (size_t pixel = first; pixel < first + size_t(mWidth); pixel++) {
        mSample[pixel] = vec3(0);
        if (!mGroundSample.empty()) mGroundSample[pixel] = vec2(0);
        const std::optional<RayHit>& hit = surfacesOf(pixel)[sampleOf(pixel)];
        if (!hit) continue;
        HashedNumbers random{uint32_t(pixel), uint32_t(mPasses)};
        const SurfacePoint point = mBound->pointAt(*hit, mCamera.eye);
        const ReflectedRadiance reflected = sampleReflection(point, *mLight, mTracer, mShadowOffset, random);
        vec3 radiance = point.emitted + reflected.shadowed;
        if (mKind == ReferenceBrdf::Exact) {
            std::array<vec3, kMostBounces> byBounces{};
            sampleBounces({*mBound, mTracer, mTracer, mMeshes, *mLight, mShadowOffset}, point,
                          std::span(byBounces).first(size_t(mBounces)), random);
            for (const vec3 bounced : byBounces) radiance += bounced;
        }
        if (isShadow(*hit))
            mGroundSample[pixel] = {luminance(radiance), luminance(reflected.unshadowed)};
        else
            mSample[pixel] = groundCoverageAt(*hit, point.position) * radiance;
    }
}

bool ProgressiveReference::addPass(std::stop_token stop) {
    RELUME_CHECK(mBound);
    std::atomic<bool> isStopped = false;
    tbb::parallel_for(0, mHeight, [&](int y) {
        if (stop.stop_requested()) isStopped = true;
        if (isStopped) return;
        findSurfaces(y);
        sampleRow(y);
    });
    if (isStopped) return false;
    std::vector<glm::dvec3>& half = mHalves[size_t(mPasses % 2)];
    for (size_t pixel = 0; pixel < half.size(); pixel++) half[pixel] += mSample[pixel];
    std::vector<vec2>& light = mGroundLight[size_t(mPasses % 2)];
    for (size_t pixel = 0; pixel < light.size(); pixel++) light[pixel] += mGroundSample[pixel];
    mPasses++;
    return true;
}

template <typename Value>
Image ProgressiveReference::imageOf(const Value& valueOf, const std::vector<vec2>& groundLight) const {
    Image image(mWidth, mHeight);
    for (size_t pixel = 0; pixel < image.pixels.size(); pixel++)
        if (const float coverage = coverageOf(pixel, groundLight.empty() ? vec2(0) : groundLight[pixel]);
            coverage > 0)
            image.pixels[pixel] = vec4(glm::max(vec3(valueOf(pixel)), vec3(0)), coverage);
    return image;
}

Image ProgressiveReference::mean() const {
    if (mPasses == 0) return Image(mWidth, mHeight);
    std::vector<vec2> light = mGroundLight[0];
    for (size_t pixel = 0; pixel < light.size(); pixel++) light[pixel] += mGroundLight[1][pixel];
    return imageOf([&](size_t pixel) { return (mHalves[0][pixel] + mHalves[1][pixel]) / double(mPasses); },
                   light);
}

std::array<Image, 2> ProgressiveReference::halves() const {
    RELUME_CHECK(mPasses >= 2);
    const double even = (mPasses + 1) / 2, odd = mPasses / 2;
    return {imageOf([&](size_t pixel) { return mHalves[0][pixel] / even; }, mGroundLight[0]),
            imageOf([&](size_t pixel) { return mHalves[1][pixel] / odd; }, mGroundLight[1])};
}

std::optional<ReferenceError> ProgressiveReference::errorOf(const Image& image) const {
    RELUME_CHECK_EQ(image.width, mWidth);
    RELUME_CHECK_EQ(image.height, mHeight);
    const double even = (mPasses + 1) / 2, odd = mPasses / 2;
    if (odd == 0) return std::nullopt;
    double errors = 0, squares = 0, differences = 0, variance = 0, alphas = 0;
    uint64_t covered = 0, counted = 0; // pixels: in all, and without those of a ground's shadow alone
    for (size_t pixel = 0; pixel < image.pixels.size(); pixel++) {
        const auto surfaces = surfacesOf(pixel);
        if (std::ranges::none_of(surfaces, [](const auto& hit) { return hit.has_value(); })) continue;
        covered++;
        if (!mGroundSample.empty()) {
            const double alpha =
                coverageOf(pixel, mGroundLight[0][pixel]) - coverageOf(pixel, mGroundLight[1][pixel]);
            alphas += alpha * alpha;
        }
        if (std::ranges::none_of(surfaces, [&](const auto& hit) { return hit && !isShadow(*hit); })) continue;
        const glm::dvec3 a = glm::max(mHalves[0][pixel] / even, 0.0);
        const glm::dvec3 b = glm::max(mHalves[1][pixel] / odd, 0.0);
        const glm::dvec3 found = glm::dvec3(vec3(image.pixels[pixel]));
        errors += glm::dot(a - found, b - found);
        squares += glm::dot(a, b);
        differences += glm::dot(a - b, a - b);
        const double swing = 0.5 * (glm::dot(a - found, a - found) - glm::dot(b - found, b - found));
        variance += swing * swing;
        counted++;
    }
    if (covered == 0) return std::nullopt;
    const double count = 3 * double(std::max<uint64_t>(counted, 1)); // of channels
    const auto root = [&](double sum) { return std::sqrt(std::max(sum / count, 0.0)); };
    // The variance of one pass is that of A - B over (1 / even + 1 / odd).
    return ReferenceError{.rmse = root(errors),
                          .level = root(squares),
                          .noise = root(differences * even * odd) / double(mPasses),
                          .alphaNoise = std::sqrt(alphas / double(covered) * even * odd) / double(mPasses),
                          .square = errors / count,
                          .squareNoise = std::sqrt(variance) / count};
}

} // namespace relume
