// Tabulates BRDFs as convolutions about the view direction (engine/scene/residual.h).
#pragma once

#include "engine/scene/residual.h"

#include <functional>

namespace relume {

// Returns f(ωi, ωo) without the cosine, for directions above the horizon in the local frame.
using Reflectance = std::function<vec3(vec3 incoming, vec3 outgoing)>;

// Tabulates a kernel with as many frequencies and harmonics as hold all but kLostEnergy of the squared sum.
// `isIsotropic` is as in Brdf. Uses all cores; deterministic.
std::shared_ptr<const SphereKernel> makeSphereKernel(const Reflectance& exact, bool isIsotropic);
constexpr double kLostEnergy = 1e-3;

} // namespace relume
