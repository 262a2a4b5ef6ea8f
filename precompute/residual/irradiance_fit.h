// Estimates irradiance from a set's tuples, using that light maps nearly span constants.
#pragma once

#include "engine/scene/factored_brdf.h"

namespace relume {

// Returns ResidualSet::irradianceWeights for these light maps.
std::vector<vec3> irradianceWeights(const FactoredBrdf& factors);

} // namespace relume
