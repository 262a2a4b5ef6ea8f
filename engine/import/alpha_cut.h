// Masked surfaces: a mesh without the parts of it that its alpha makes holes.
#pragma once

#include "engine/scene/mesh.h"
#include "engine/scene/texture.h"

#include <string>

namespace relume {

// Alpha over a surface: `factor` times a texture's, where there is one, times that of vertex colors.
struct AlphaMask {
    const Texture* texture = nullptr; // by the mesh's uvs, of which there must be some; A is used
    float factor = 1;
    float cutoff = 0.5f; // what has less is a hole
};

// Returns the part of a clean mesh where alpha is no less than the cutoff. Triangles are split until straight
// cuts through them leave no texel's center on the wrong side by more than `tolerance` (units of length) or
// half a texel, whichever is more. Texels are not looked between. No T-junctions arise, except along seams of
// the texture coordinates. A mesh without holes stays as it is; one that is all hole has no triangles. Where
// 200,000 more triangles do not suffice, cuts stay coarser, and a warning says so, in which `name` stands for
// the mesh.
Mesh cutByAlpha(Mesh mesh, const AlphaMask& mask, float tolerance, const std::string& name);

} // namespace relume
