// Triangulation of polygons.
#pragma once

#include "engine/math/vector.h"

#include <span>
#include <string>
#include <vector>

namespace relume {

// The most corners of a concave polygon: clipping its ears takes cubic time at worst.
constexpr size_t kMostConcaveCorners = 128;

// Fills a polygon, given by its three or more corner positions, with triangles of indices into `corners`, and
// appends these; the winding is kept. Quadrilaterals are cut along their shorter inner diagonal, other convex
// polygons into a fan, concave ones by clipping ears (Meisters 1975) in the plane of Newell's normal. Throws
// Error for a concave polygon of more than kMostConcaveCorners corners; `name` names the file in it.
void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles, const std::string& name);

} // namespace relume
