// Whether the back of a surface can be seen from outside.
#pragma once

#include "engine/scene/mesh.h"

#include <vector>

namespace relume {

// Returns for every triangle whether it is of a closed piece. Pieces are what edges of two triangles join,
// whatever vertices the corners are (those in the same place are one). A closed piece goes along each of its
// edges as often one way as the other, and encloses a volume with its triangles counter-clockwise as seen
// from outside: from there it shows no back, unless it passes through itself with a part inside out.
// Triangles in a single place are of no piece.
std::vector<bool> trianglesOfClosedPieces(const Mesh& mesh);

// Returns whether all triangles but those in a single place are of closed pieces, and there are such.
bool isClosed(const Mesh& mesh);

} // namespace relume
