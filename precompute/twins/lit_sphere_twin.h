// The CPU twin of lit spheres, stage by stage, naive: engine/render/lit_spheres.h.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/scene/factored_brdf.h"
#include "engine/scene/residual.h"

namespace relume {

// Six faces of kSphereCubeBordered² texels: sphere_cube.comp.
std::vector<vec3> sphereCube(const LightCube& light);

// A light in the middle of what each cell emits: sphere_cube.comp.
struct CellLight {
    vec3 direction;
    vec3 energy; // radiance · solid angle
};
std::vector<CellLight> cellLights(const LightCube& light);

// kTupleRings × kTupleAzimuths × terms, of normals about +Y, in the frames that follow from them; or
// kTurnedRows × kTupleAzimuths × terms, in frames turned from these: unshadowed_tuples.comp.
std::vector<vec3> unshadowedTuples(const std::vector<CellLight>& lights, const FactoredBrdf& factors,
                                   bool isTurned = false);

// kSphereRings × kSphereAzimuths of radiance · solid angle about a direction: sphere_light.comp.
std::vector<vec3> polarLight(const std::vector<vec3>& cube, vec3 direction);

// 2 H + 1 spheres of kSphereRings × kSphereAzimuths, as LitSpheres::image() has them: the other passes, as
// one sum over the light's rings and azimuths.
std::vector<vec3> litSpheres(const SphereKernel& kernel, const std::vector<vec3>& polarLight);

// Their sum, unshadowed radiance, where the view has azimuth `azimuth` in the frame of `texel`, ring by ring.
vec3 litSphereRadiance(const SphereKernel& kernel, const std::vector<vec3>& spheres, size_t texel,
                       float azimuth);

} // namespace relume
