// Reduces flat, convex meshes, such as grounds, to a few triangles.
#pragma once

#include "engine/scene/mesh.h"

#include <optional>

namespace relume {

// Returns the same surface with the fewest triangles, positions only, if `mesh` lies in one plane and covers
// a convex polygon once (both within 1e-5, relative to its extent and area); otherwise nothing.
std::optional<Mesh> reduceFlat(const Mesh& mesh);

} // namespace relume
