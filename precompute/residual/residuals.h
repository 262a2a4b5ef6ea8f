// Everything that drawing an asset with the residual takes: made of its materials' descriptions, in a second
// or so.
#pragma once

#include "engine/render/residual.h"
#include "precompute/reference/material_brdfs.h"

namespace relume {

// Makes the residual of every part and set. It is null where the K terms are the BRDF, as of diffuse
// materials, and where the BRDF's data is gone, with a warning in the log. Parts of the same materials share
// their residual.
Residuals makeResiduals(const Asset& asset);

} // namespace relume
