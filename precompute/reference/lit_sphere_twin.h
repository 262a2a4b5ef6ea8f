// The CPU twin of lit spheres, stage by stage, naive: engine/render/lit_spheres.h.
#pragma once

#include "engine/light/light_cube.h"
#include "engine/render/residual.h"
#include "engine/scene/factored_brdf.h"

namespace relume {

// Six faces of kSphereCubeBordered² texels: sphere_cube.comp.
std::vector<vec3> sphereCube(const LightCube& light);

// A light in the middle of what each cell emits: sphere_cube.comp.
struct CellLight {
    vec3 direction;
    vec3 energy; // radiance · solid angle
};
std::vector<CellLight> cellLights(const LightCube& light);

// kTupleRings × kTupleAzimuths × terms, of normals about +Y: unshadowed_tuples.comp.
std::vector<vec3> unshadowedTuples(const std::vector<CellLight>& lights, const FactoredBrdf& factors);

// kSphereRings × kSphereAzimuths of radiance · solid angle about a direction: sphere_light.comp.
std::vector<vec3> polarLight(const std::vector<vec3>& cube, vec3 direction);

// kSphereRings × kSphereAzimuths of unshadowed radiance towards that direction: the other passes, as one sum
// over the light's rings and azimuths.
std::vector<vec3> litSphere(const SphereKernel& kernel, const std::vector<vec3>& polarLight, vec3 direction);

} // namespace relume
