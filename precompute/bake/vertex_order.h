// The order of vertices in a bake: neighbors in space that face the same way share a cluster and a block.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

constexpr uint32_t kOrderedVertices = 256; // of a cluster

// Reorders the mesh's vertices into clusters of kOrderedVertices, the last may have fewer: halved at the
// median of the widest of position, in units of a cluster's side, and normal, until a cluster is left. Ties,
// and the order within a cluster, are along a Morton curve of position (10 bits an axis), ties by the octant
// and then the Morton code of the normal, then by original index; triangles are renumbered and sorted by
// smallest index, so that equal meshes give equal bytes.
void orderVertices(Mesh& mesh);

} // namespace relume
