// An asset with materials bound to its parts: the surface that a ray meets, and how it reflects.
#pragma once

#include "engine/math/tangent_frame.h"
#include "precompute/reference/bound_brdf.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Meshes of the parts: RayHit::mesh of a tracer of these is a part.
std::vector<const Mesh*> partMeshes(const Asset& asset);
// All of them as one, which the bake's occluder may be simpler than.
Mesh mergedMesh(const Asset& asset);

// A point of a surface, seen from an eye. Refers to its BoundAsset.
struct SurfacePoint {
    struct Layer {
        vec3 weight;
        SeenBrdf brdf;
    };
    vec3 position;
    vec3 normal; // interpolated: rays start along it
    TangentFrame
        frame;     // of it and of the tangent; with the exact BRDF, of the normal that a normal map gives
    vec3 outgoing; // the view direction in the frame, above the horizon
    std::vector<Layer> layers;
    vec3 emitted; // radiance of its own

    // Σ weight · f(ωi, outgoing), in sr⁻¹; ωi in the frame, above the horizon.
    vec3 reflected(vec3 incoming) const;
    std::vector<vec3> layerWeights() const;
};

class BoundAsset {
  public:
    // Refers to `asset`, whose normal maps are those of the exact BRDF alone: factors are of the frames that
    // they were baked in. Exact BRDFs come from `brdfs`, which throws if they cannot be had.
    BoundAsset(const Asset& asset, const Appearance& appearance, ReferenceBrdf kind, MaterialBrdfs& brdfs);

    // Attributes are interpolated as in the view pass.
    SurfacePoint pointAt(const RayHit& hit, vec3 eye) const { return pointAt(hit, eye, mIsExact); }
    // The same in the frame that transport was baked in, without a normal map.
    SurfacePoint bakedPointAt(const RayHit& hit, vec3 eye) const { return pointAt(hit, eye, false); }
    // The latter with every layer times concentrationOf() its kernel: what unshadowed radiance at the normal
    // of a normal map is limited by. Of sets with a residual.
    SurfacePoint limitPointAt(const RayHit& hit, vec3 eye) const;

  private:
    SurfacePoint pointAt(const RayHit& hit, vec3 eye, bool isMapped) const;

    struct Part {
        size_t set;
        std::vector<BoundLayer> layers;
        std::vector<BoundBrdf> brdfs; // of the layers
    };
    const Asset* mAsset;
    bool mIsExact;
    std::vector<Part> mParts;
};

} // namespace relume
