// Tests whether the back of a surface can be seen from outside.
#pragma once

#include "engine/scene/mesh.h"

#include <vector>

namespace relume {

// Returns for every triangle whether it belongs to a closed piece. A piece is a set of triangles connected by
// edges that two triangles share; corners in the same place are one corner. A closed piece runs along each of
// its edges equally often in both directions and encloses a positive volume, its triangles counter-clockwise
// seen from outside. From outside it shows no back face, unless it intersects itself with a part inside out.
// A triangle whose corners are all in the same place belongs to no piece.
std::vector<bool> findClosedTriangles(const Mesh& mesh);

// Returns whether there are closed pieces and every triangle belongs to one, not counting triangles whose
// corners are all in the same place.
bool isClosed(const Mesh& mesh);

} // namespace relume
