// Makes residuals from the descriptions of materials.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/asset.h"

namespace relume {

// Makes MaterialSet::residual of the sets that have none, which takes about a second. It stays null, with a
// warning, where a BRDF's data is missing. Sets whose terms are exact get a residual only if `includesExact`.
void makeResiduals(Asset& asset, bool includesExact = false);

// Returns ResidualSet::irradianceWeights for these light maps.
std::vector<vec3> irradianceWeights(const FactoredBrdf& factors);

} // namespace relume
