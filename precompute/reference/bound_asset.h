// An asset with materials bound to its parts: evaluates the surface at a ray's hit and its reflection.
#pragma once

#include "engine/math/tangent_frame.h"
#include "precompute/reference/bound_brdf.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Returns the meshes of the parts, for a tracer whose RayHit::mesh is the part.
std::vector<const Mesh*> partMeshes(const Asset& asset);
// Returns all of them as one mesh. The bake's occluder may be a simplified version of it.
Mesh mergedMesh(const Asset& asset);

// A point on a surface, seen from an eye. Keeps a reference to its BoundAsset.
struct SurfacePoint {
    struct Layer {
        vec3 weight;
        SeenBrdf brdf;
    };
    vec3 position;
    vec3 normal;        // interpolated; rays are offset along it
    TangentFrame frame; // of this normal (with the exact BRDF, of the mapped one) and the tangent
    vec3 outgoing;      // view direction in the frame, above the horizon
    std::vector<Layer> layers;
    vec3 emitted; // emitted radiance

    // Returns Σ weight · f(ωi, outgoing) in sr⁻¹; ωi is in the frame, above the horizon.
    vec3 reflected(vec3 incoming) const;
    std::vector<vec3> layerWeights() const;
};

class BoundAsset {
  public:
    // Keeps a reference to `asset`. Normal maps apply only to the exact BRDF, since factors belong to the
    // frames in which they were baked. Exact BRDFs come from `brdfs`, which throws if it cannot make them.
    BoundAsset(const Asset& asset, const Appearance& appearance, ReferenceBrdf kind, MaterialBrdfs& brdfs);

    // Returns the point at a hit, with attributes interpolated as in the view pass.
    SurfacePoint pointAt(const RayHit& hit, vec3 eye) const { return pointAt(hit, eye, mIsExact); }
    // Returns the same in the frame of the baked transport, without a normal map.
    SurfacePoint bakedPointAt(const RayHit& hit, vec3 eye) const { return pointAt(hit, eye, false); }
    // Returns bakedPointAt() with every layer scaled by concentrationOf() its kernel: the limit of unshadowed
    // radiance at a mapped normal. For sets with a residual.
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
