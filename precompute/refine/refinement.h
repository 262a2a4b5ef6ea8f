// Adds vertices where interpolation between vertices would be visible.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake_observer.h"
#include "precompute/refine/refinement_record.h"

namespace relume {

struct RefinementGoal {
    double wanted;                                // error
    uint64_t mostVertices = kMostRefinedVertices; // of the refined parts, at most
    std::vector<bool> isRefined = {};             // per part; empty: all
};

// Splits edges of the parts' meshes until the estimated error (RefinementRecord) is at most the wanted one.
// Sets must be factored and have no transport. Vertices go where they reduce the error most, in whichever
// part. Edges with common endpoints, in one part or several, are split together, and are kept if one belongs
// to a part that is not refined, so that no cracks appear. Old vertices stay in place, new ones follow. The
// result does not depend on the number of threads.
//
// Edges shorter than a few `visibilityOffset`s are kept, and vertices are limited to the goal's maximum;
// refinement also ends when the edges that may be split contribute almost nothing. The error can then remain
// above the wanted one. Throws Error if the parts start with more than kMostRefinedVertices, and BakeStopped
// if `observer` wants it.
RefinementRecord refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset,
                        const RefinementGoal& goal, BakeObserver& observer);

} // namespace relume
