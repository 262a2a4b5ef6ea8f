// Everything that drawing an asset with the residual takes: made of its materials' descriptions, in a second
// or so.
#pragma once

#include "engine/render/residual.h"
#include "precompute/reference/material_brdfs.h"

namespace relume {

// Of every part and set. Null where K terms are the BRDF, as for what is diffuse; and where a BRDF cannot be
// had any more, with a warning in the log. Parts of the same materials share their sets.
Residuals makeResiduals(const Asset& asset);

} // namespace relume
