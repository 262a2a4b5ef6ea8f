// How a set's tuples tell irradiance: light maps nearly span what is constant.
#pragma once

#include "engine/scene/factored_brdf.h"

namespace relume {

// ResidualSet::irradianceWeights of these light maps.
std::vector<vec3> irradianceWeights(const FactoredBrdf& factors);

} // namespace relume
