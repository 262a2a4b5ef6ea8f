// Computes the radiance of points as drawn, and with one approximation after another made exact.
#pragma once

#include "precompute/bake/bake_options.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/error/baked_transport.h"
#include "precompute/error/drawn_light.h"
#include "precompute/error/error_source.h"
#include "precompute/error/tabulated_brdf.h"
#include "precompute/error/unshadowed_light.h"
#include "precompute/reference/bound_asset.h"

#include <functional>

namespace relume {

// Linear radiance of a point: [0] as drawn, [i + 1] with ErrorSource(i) and all sources before it made exact.
// Stages computed from factors include the residual, as pixels do, or are clamped at zero. The last is the
// truth except for noise and discretization: the exact BRDF and the full mesh under 6 × 256² texels of light,
// four shadow rays per texel, kStagePaths paths for light from other surfaces.
using StageRadiance = std::array<vec3, kErrorSources + 1>;

constexpr int kTruthFaceSize = 256;   // texels per side of a face of the light that stands for the truth
constexpr int kTruthVisibility = 512; // rays per side of a face
constexpr int kStagePaths = 512;      // per point and light, if light bounces

// A light as the stages use it.
struct StageLight {
    DrawnLight drawn;
    LightCube fine; // kTruthFaceSize texels per side; may be negative
};

struct StageOptions {
    bool addsResidual = true; // draw sets with their residuals
    int bounces = 0;          // reflections between surfaces in the truth, at least the asset's own
    // The bounced light in the asset's bake; null if it has no bounces.
    std::shared_ptr<const BouncedTransport> bounced = {};
};

class StageTracer {
  public:
    // Keeps references to `asset` and to `appearance`, its bound materials. Throws Error as Embree,
    // makeBrdf() and optionsOf() (baked_options.h) do.
    StageTracer(const Asset& asset, const Appearance& appearance, const StageOptions& options = {});

    // Returns the stages [light][point] of points hit by rays from `eye` (RayHit::mesh is the part). Since no
    // image is given, [0] equals [1]. Uses all cores; the same input gives the same values. `progress` is
    // called with the share done, now and then and from one thread at a time; what it throws ends the work.
    std::vector<std::vector<StageRadiance>> trace(std::span<const RayHit> points, vec3 eye,
                                                  std::span<const StageLight> lights,
                                                  const std::function<void(double)>& progress = {}) const;

  private:
    StageTracer(const Asset& asset, const Appearance& appearance, const StageOptions& options,
                const BakeOptions& baked);

    struct DrawnPart;
    struct Light;
    struct Tuples;
    struct Vertices;
    struct Binding;

    Light prepare(const StageLight& light) const;
    Tuples vertexTuples(size_t part, uint32_t vertex, std::span<const Light> lights) const;
    // `baked` is the point in the frame of its transport.
    Binding bindingAt(size_t part, const SurfacePoint& baked) const;
    // Returns the sums [light][LightPart]; zeros if terms are drawn without a residual.
    std::vector<UnshadowedLight> unshadowedAt(const SurfacePoint& point, const SurfacePoint& baked,
                                              const SurfacePoint& limit, const Binding& binding,
                                              std::span<const Light> lights) const;
    void traceVertices(const RayHit& hit, const Binding& binding, std::span<const UnshadowedLight> unshadowed,
                       const Vertices& vertices, std::span<StageRadiance> result) const;
    // Returns, per light, what baked bounces add to the radiance.
    std::vector<vec3> traceOwnTransport(const RayHit& hit, const SurfacePoint& point, const SurfacePoint& own,
                                        const Binding& binding, std::span<const UnshadowedLight> unshadowed,
                                        const Vertices& vertices, std::span<const uint64_t> baked,
                                        std::span<const Light> lights, std::span<StageRadiance> result) const;
    void traceTruth(const SurfacePoint& point, std::span<const uint64_t> baked, std::span<const Light> lights,
                    std::span<const vec3> bounced, std::span<StageRadiance> result) const;
    // `number` seeds the paths of a point.
    void tracePaths(const SurfacePoint& point, uint32_t number, std::span<const Light> lights,
                    std::span<const vec3> bounced, std::span<StageRadiance> result) const;

    const Asset& mAsset;
    const Appearance& mAppearance;
    StageOptions mOptions;
    MaterialBrdfs mBrdfs;
    BoundAsset mBound;
    std::vector<TabulatedBrdf> mTables; // per part: tables of the bound set
    BakedTransport mBaked;
    CubeCells mTruth;
    CpuVisibility mFull;     // the mesh itself, with as many rays as in the bake
    CpuVisibility mFullFine; // the mesh itself, with four rays per texel of the truth's light
    float mFullOffset;
    std::vector<const Mesh*> mMeshes; // per part
    RayTracer mSurfaces;              // one mesh per part: what paths hit
};

} // namespace relume
