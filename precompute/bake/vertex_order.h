// Puts vertices in bake order: neighbors that face the same way share a cluster and a block.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

constexpr uint32_t kOrderedVertices = 256; // per cluster

// Reorders the mesh's vertices into clusters of kOrderedVertices, the last of which may be smaller, by
// halving them at the median along the axis in which position (in units of a cluster's side) or normal varies
// most. Ties and the order within a cluster follow a Morton curve of position (10 bits per axis), then the
// octant and Morton code of the normal, then the original index. Triangles are renumbered and sorted by
// smallest index. Equal meshes give equal bytes.
void orderVertices(Mesh& mesh);

} // namespace relume
