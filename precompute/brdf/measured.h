// Measured BRDFs: isotropic, reciprocal, from a file.
#pragma once

#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_parameters.h"

#include <filesystem>

namespace relume {

// {"measured": PATH, "scale": s, "hash": h}: a MERL or Cornell file (merl.h, cornell.h), told apart by its
// first bytes; a relative path starts at `folder`. Every value is multiplied by s (default 1). With a hash,
// as describe() gives it, a file of other content is refused. Throws Error naming the path and remedy.
std::unique_ptr<Brdf> makeMeasured(MaterialParameters& parameters, const std::filesystem::path& folder);

} // namespace relume
