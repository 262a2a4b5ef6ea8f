// Masked surfaces: removal of the parts of a mesh where alpha makes holes.
#pragma once

#include "engine/scene/mesh.h"
#include "engine/scene/texture.h"

#include <string>

namespace relume {

// Alpha over a surface: `factor` times a texture's alpha, if there is one, times that of vertex colors.
struct AlphaMask {
    const Texture* texture = nullptr; // sampled at the mesh's uvs, which must exist
    float factor = 1;
    float cutoff = 0.5f; // alpha below this is a hole
};

// Returns the part of a clean mesh where alpha is at least the cutoff. Triangles are split until straight
// cuts through them leave no texel's center on the wrong side by more than `tolerance` (units of length) or
// half a texel, whichever is more; the surface between texels is not examined. No T-junctions arise, except
// along seams of the texture coordinates. A mesh without holes stays as it is; one that is all hole has no
// triangles. If 200,000 more triangles do not suffice, cuts stay coarser, and the log warns of mesh `name`.
Mesh cutByAlpha(Mesh mesh, const AlphaMask& mask, float tolerance, const std::string& name);

} // namespace relume
