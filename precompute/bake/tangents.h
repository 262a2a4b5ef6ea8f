// The directions that anisotropic materials are brushed in.
#pragma once

#include "engine/scene/mesh.h"

#include <functional>

namespace relume {

// Gives every vertex a tangent, if the mesh has none: along u of its texture coordinates if it has these,
// else of the smooth field below. Then all are turned about their normals, counter-clockwise. Returns
// false if `wantsStop`, which is asked now and then, ended it.
bool makeTangents(Mesh& mesh, float degrees = 0, const std::function<bool()>& wantsStop = {});

// Returns unit tangents, one per vertex, that are smooth over the surface and near tangentFrame() of the
// normals: they minimise ∫ |∇u|² + |u - q|² / l² with q the latter and l a tenth of the mesh's radius, where
// ∇ compares neighbors as parallel transport between their tangent planes does (Knöppel, Crane, Pinkall and
// Schröder: Globally Optimal Direction Fields, 2013). A closed surface has singular points whatever one does:
// with these two, a distance of about l apart, in place of the one of q where the normal is -Y, about which q
// turns twice. Empty if stopped.
std::vector<vec3> smoothTangents(const Mesh& mesh, const std::function<bool()>& wantsStop = {});

} // namespace relume
