// The order of vertices in a bake: along a space-filling curve, so that neighbours share a block.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// Reorders the mesh's vertices along a Morton curve of position (10 bits an axis), ties by the octant
// and then the Morton code of the normal, then by original index; triangles are renumbered and sorted
// by smallest index, so that equal meshes give equal bytes.
void orderVertices(Mesh& mesh);

} // namespace relume
