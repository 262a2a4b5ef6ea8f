// Vertices where interpolation between them would be seen.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/bake_observer.h"

namespace relume {

// What --refine may ask for.
constexpr double kLeastRefinementError = 0.001, kMostRefinementError = 1;

struct Refinement {
    double error = 0;        // as it was left
    double startError = 0;   // of the meshes as given
    uint64_t startVertices = 0, vertices = 0;
    bool isLimited = false; // more vertices would be needed than there may be
};

// Splits edges of the parts' meshes, whose sets are factored and without transport, until the error of
// interpolating transport is estimated to be `wanted`, or less: root mean square over the surface of all
// parts of what interpolation does to reflected light, as light of all scales weighs it (light_spectrum.h),
// relative to the root mean square of that light. Vertices go where they help most. Edges that lie on each
// other, in one part or in several, are split together: no cracks. The same for any number of threads.
//
// Edges shorter than a few `visibilityOffset`s stay whole, and there are never more than kMostRefinedVertices.
// Throws BakeStopped where `observer` asks for it.
Refinement refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset, double wanted,
                  BakeObserver& observer);

constexpr uint64_t kMostRefinedVertices = 1u << 20;

} // namespace relume
