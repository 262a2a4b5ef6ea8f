// Computes the tangents that brushed (anisotropic) materials follow.
#pragma once

#include "engine/scene/mesh.h"

#include <functional>

namespace relume {

// Gives every vertex a tangent if the mesh has none: along u of the texture coordinates, or else from
// smoothTangents(). Then rotates all tangents counter-clockwise about their normals by `degrees`. Returns
// false if `wantsStop`, which is polled now and then, ended it.
bool makeTangents(Mesh& mesh, float degrees = 0, const std::function<bool()>& wantsStop = {});

// Returns unit tangents, one per vertex, that are smooth over the surface and near tangentFrame() of the
// normals. They minimize ∫ |∇u|² + |u - q|² / l², where q is that frame's tangent, l a tenth of the mesh's
// radius, and ∇ compares neighbors by parallel transport between their tangent planes (Knöppel, Crane,
// Pinkall and Schröder, "Globally Optimal Direction Fields", 2013). Every smooth field on a closed surface
// has singular points: this one has two, about l apart, where q has a single one of index two (normal -Y).
// Returns nothing if stopped.
std::vector<vec3> smoothTangents(const Mesh& mesh, const std::function<bool()>& wantsStop = {});

} // namespace relume
