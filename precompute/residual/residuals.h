// Makes residuals from the descriptions of materials.
#pragma once

#include "engine/transport/asset.h"

namespace relume {

// Makes MaterialSet::residual of the sets that have none, which takes about a second. It stays null, with a
// warning, where a BRDF's data is missing. Sets whose terms are exact get a residual only if `isOfAll`.
void makeResiduals(Asset& asset, bool isOfAll = false);

} // namespace relume
