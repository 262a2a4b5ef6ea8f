// Whether the back of a surface can be seen from outside.
#pragma once

#include "engine/scene/mesh.h"

namespace relume {

// Every edge is shared by two triangles that turn the same way, whatever vertices the corners are (those in
// the same place are one), and every piece of triangles that edges join encloses a volume with its triangles
// counter-clockwise as seen from outside. From outside a mesh whose pieces do not pass through themselves,
// with a part inside out, shows no back.
bool isClosed(const Mesh& mesh);

} // namespace relume
