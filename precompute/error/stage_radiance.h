// The radiance of points as it is drawn, and with one stage of Relume after another made exact.
#pragma once

#include "engine/light/light_vector.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/error/baked_transport.h"
#include "precompute/error/error_source.h"
#include "precompute/error/tabulated_brdf.h"
#include "precompute/error/unshadowed_light.h"
#include "precompute/reference/bound_asset.h"

#include <functional>

namespace relume {

// Linear radiance of a point: [0] as drawn, [i + 1] with ErrorSource(i) and all before it made exact. Those
// from factors are estimated with what the factors leave, as pixels are, or clamped at zero. The last is the
// truth but for the number of rays: the exact BRDF and the full mesh under 6 × 256² texels of light, four
// shadow rays a texel, kStagePaths paths for light of other surfaces.
using StageRadiance = std::array<vec3, kErrorSources + 1>;

constexpr int kTruthFaceSize = 256;   // texels a side of the light that stands for the truth
constexpr int kTruthVisibility = 512; // rays a side
constexpr int kStagePaths = 512;      // a point and light, where light bounces

// A light at every stage.
struct StageLight {
    LightVector drawn; // the coarse one, selected and quantized
    LightCube coarse;  // F texels a side: what the bake can be lit by
    LightCube fine;    // kTruthFaceSize; may be negative
};

struct StageOptions {
    bool addsResidual = true; // sets are drawn with their residuals
    int bounces = 0;          // reflections between surfaces that the truth has, at least the asset's own
    // The bounced light that the asset was baked with; null where it has none.
    std::shared_ptr<const BouncedTransport> bounced = {};
};

class StageTracer {
  public:
    // Refers to both; `appearance` is how the asset looks. Throws Error as Embree, as makeBrdf(), and as
    // baked_options.h's optionsOf().
    StageTracer(const Asset& asset, const Appearance& appearance, const StageOptions& options = {});

    // Of points that rays from `eye` hit (RayHit::mesh is the part), under each light: [light][point]. On all
    // cores; the same input gives the same values. No image is known here: [0] is as [1]. `progress` is
    // called with the share of work done, now and then, from one thread at a time; what it throws ends the
    // work.
    std::vector<std::vector<StageRadiance>> trace(std::span<const RayHit> points, vec3 eye,
                                                  std::span<const StageLight> lights,
                                                  const std::function<void(double)>& progress = {}) const;

  private:
    StageTracer(const Asset& asset, const Appearance& appearance, const StageOptions& options,
                const BakeOptions& baked);

    struct Light;
    struct Tuples;
    struct Vertices;
    struct Binding;

    Light prepare(const StageLight& light) const;
    Tuples vertexTuples(size_t part, uint32_t vertex, std::span<const Light> lights) const;
    // `baked`: the point in the frame of its transport.
    Binding bindingAt(size_t part, const SurfacePoint& baked) const;
    // Per light; of nothing where terms are drawn alone.
    std::vector<UnshadowedLight> unshadowedAt(const SurfacePoint& point, const SurfacePoint& baked,
                                              const SurfacePoint& limit, const Binding& binding,
                                              std::span<const Light> lights) const;
    void traceVertices(const RayHit& hit, const Binding& binding, std::span<const UnshadowedLight> unshadowed,
                       const Vertices& vertices, std::span<StageRadiance> result) const;
    // Returns, per light, what baked bounces add to the estimate.
    std::vector<vec3> traceOwnTransport(const RayHit& hit, const SurfacePoint& point, const SurfacePoint& own,
                                        const Binding& binding, std::span<const UnshadowedLight> unshadowed,
                                        const Vertices& vertices, std::span<const uint64_t> baked,
                                        std::span<const Light> lights, std::span<StageRadiance> result) const;
    void traceTruth(const SurfacePoint& point, std::span<const uint64_t> baked, std::span<const Light> lights,
                    std::span<const vec3> bounced, std::span<StageRadiance> result) const;
    // `number` tells the paths of one point from another's.
    void tracePaths(const SurfacePoint& point, uint32_t number, std::span<const Light> lights,
                    std::span<const vec3> bounced, std::span<StageRadiance> result) const;

    const Asset& mAsset;
    const Appearance& mAppearance;
    StageOptions mOptions;
    MaterialBrdfs mBrdfs;
    BoundAsset mBound;
    std::vector<TabulatedBrdf> mTables; // per part, of the bound set
    BakedTransport mBaked;
    CubeCells mTruth;
    CpuVisibility mFull;     // the mesh itself, with as many rays as the bake's
    CpuVisibility mFullFine; // and with four for each texel of the truth's light
    float mFullOffset;
    std::vector<const Mesh*> mMeshes; // of the parts
    RayTracer mSurfaces;              // one mesh per part: what paths meet
};

} // namespace relume
