// Vertices where interpolation between them would be seen.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/bake/bake_observer.h"
#include "precompute/refine/refinement_record.h"

namespace relume {

// Splits edges of the parts' meshes, whose sets are factored and have no transport, until the error is
// estimated to be `wanted`, or less: RefinementRecord. Vertices go where they help most, whichever part it
// is. Edges that lie on each other, in one part or in several, are split together: no cracks. New vertices
// come after the old ones, which stay. The same for any number of threads.
//
// Edges shorter than a few `visibilityOffset`s stay whole, and there are never more than
// kMostRefinedVertices; where the edges that may be split make next to nothing of the error it ends as well:
// what is left may be above `wanted`. Throws Error for parts that have more
// to begin with, and BakeStopped where `observer` asks for it.
RefinementRecord refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset,
                        double wanted, BakeObserver& observer);

} // namespace relume
