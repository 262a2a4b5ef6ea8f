// Flat, convex meshes, such as grounds, as a few triangles.
#pragma once

#include "engine/scene/mesh.h"

#include <optional>

namespace relume {

// The same surface with the fewest triangles, if all of `mesh` lies in one plane and fills a convex polygon
// once (both within 1e-5, relative to its extent and area); nothing otherwise. Positions and triangles only.
std::optional<Mesh> reduceFlat(const Mesh& mesh);

} // namespace relume
