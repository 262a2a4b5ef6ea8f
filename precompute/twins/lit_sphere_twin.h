// The CPU twins of the stages of lit spheres (engine/render/lit_spheres.h); deliberately naive.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/scene/factored_brdf.h"
#include "engine/scene/residual.h"

namespace relume {

// Twin of sphere_cube.comp: returns six faces of kSphereCubeBordered² texels.
std::vector<vec3> sphereCube(const LightCube& light);

// Twin of sphere_cube.comp: a cell's light, concentrated where the center of emission of `whole` is.
struct CellLight {
    vec3 direction;
    vec3 energy; // radiance · solid angle
};
std::vector<CellLight> cellLights(const LightCube& light, const LightCube& whole);

// Twin of unshadowed_tuples.comp: returns kTupleRings × kTupleAzimuths × terms for normals about +Y, in the
// frames that follow from them; if `isTurned`, kTurnedRows × kTupleAzimuths × terms in frames rotated from
// these.
std::vector<vec3> unshadowedTuples(const std::vector<CellLight>& lights, const FactoredBrdf& factors,
                                   bool isTurned = false);

// Twin of sphere_light.comp: returns kSphereRings × kSphereAzimuths of radiance · solid angle about a
// direction.
std::vector<vec3> polarLight(const std::vector<vec3>& cube, vec3 direction);

// Twin of the other passes, as one sum over the light's rings and azimuths: returns 2 H + 1 spheres of
// kSphereRings × kSphereAzimuths, as LitSpheres::image() has them.
std::vector<vec3> litSpheres(const SphereKernel& kernel, const std::vector<vec3>& polarLight);

// Returns their sum, the unshadowed radiance, for a view of this azimuth in the frame of `texel`; texels are
// ring by ring.
vec3 litSphereRadiance(const SphereKernel& kernel, const std::vector<vec3>& spheres, size_t texel,
                       float azimuth);

} // namespace relume
