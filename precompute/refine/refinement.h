// Vertices where interpolation between them would be seen.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake_observer.h"
#include "precompute/refine/refinement_record.h"

namespace relume {

struct RefinementGoal {
    double wanted;                                // the error
    uint64_t mostVertices = kMostRefinedVertices; // of the refined parts
    std::vector<bool> isRefined = {};             // per part; empty: all are
};

// Splits edges of the parts' meshes, whose sets are factored and have no transport, until the error is
// estimated to be as wanted, or less: RefinementRecord. Vertices go where they help most, whichever part it
// is. Edges that lie on each other, in one part or in several, are split together, and stay whole where one
// is of a part that is not refined: no cracks. New vertices come after the old ones, which stay. The same for
// any number of threads.
//
// Edges shorter than a few `visibilityOffset`s stay whole, and there are never more than the most vertices;
// where the edges that may be split make next to nothing of the error it ends as well: what is left may be
// above the error that is wanted. Throws Error for parts that have more vertices than kMostRefinedVertices to
// begin with, and BakeStopped where `observer` asks for it.
RefinementRecord refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset,
                        const RefinementGoal& goal, BakeObserver& observer);

} // namespace relume
