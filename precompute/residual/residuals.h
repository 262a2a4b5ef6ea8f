// Residuals from materials' descriptions.
#pragma once

#include "engine/transport/asset.h"

namespace relume {

// Makes MaterialSet::residual of the sets that have none, in a second or so; where a BRDF's data is gone it
// stays null, with a warning in the log. Sets whose terms are exact need none, and get one if `isOfAll`.
void makeResiduals(Asset& asset, bool isOfAll = false);

} // namespace relume
