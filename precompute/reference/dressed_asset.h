// An asset in what its parts wear: the surface that a ray meets, and how it reflects.
#pragma once

#include "engine/math/tangent_frame.h"
#include "precompute/reference/worn_brdf.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// Meshes of the parts: RayHit::mesh of a tracer of these is a part.
std::vector<const Mesh*> partMeshes(const Asset& asset);
// All of them as one, which the bake's occluder may be simpler than.
Mesh mergedMesh(const Asset& asset);

// A point of a surface, seen from an eye. Refers to its DressedAsset.
struct SurfacePoint {
    struct Layer {
        vec3 weight;
        SeenBrdf brdf;
    };
    vec3 position;
    TangentFrame frame; // of the interpolated normal and tangent
    vec3 outgoing;      // the view direction in the frame, above the horizon
    std::vector<Layer> layers;

    // Σ weight · f(ωi, outgoing), in sr⁻¹; ωi in the frame, above the horizon.
    vec3 reflected(vec3 incoming) const;
    std::vector<vec3> layerWeights() const;
};

class DressedAsset {
  public:
    // Refers to `asset`. Exact BRDFs come from `brdfs`, which throws if they cannot be had.
    DressedAsset(const Asset& asset, const Appearance& appearance, ReferenceBrdf kind, MaterialBrdfs& brdfs);

    // Attributes are interpolated as in the view pass.
    SurfacePoint pointAt(const RayHit& hit, vec3 eye) const;

  private:
    struct Part {
        size_t set;
        std::vector<WornLayer> layers;
        std::vector<WornBrdf> brdfs; // of the layers
    };
    const Asset* mAsset;
    std::vector<Part> mParts;
};

} // namespace relume
