// Polygons to triangles.
#pragma once

#include "engine/math/vector.h"

#include <span>
#include <string>
#include <vector>

namespace relume {

// Corners of a polygon beyond which a concave one is refused: clipping its ears takes cubic time at worst.
constexpr size_t kMostConcaveCorners = 128;

// Appends triangles of indices into `corners` that fill the polygon with these corner positions (three or
// more), winding kept: quadrilaterals are cut along their shorter inner diagonal, other convex polygons
// into a fan, concave ones by clipping ears (Meisters 1975) in the plane of Newell's normal. Throws Error
// for a concave polygon of more than kMostConcaveCorners; `name` stands for the file in it.
void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles, const std::string& name);

} // namespace relume
