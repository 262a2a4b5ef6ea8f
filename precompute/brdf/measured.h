// Measured BRDFs, isotropic and reciprocal, read from a file.
#pragma once

#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_parameters.h"

#include <filesystem>

namespace relume {

// Makes a BRDF from {"measured": PATH, "scale": s, "hash": h}: a MERL or Cornell file (merl.h, cornell.h),
// told apart by content; a relative path starts at `folder`. Values are multiplied by s (default 1). If a
// hash is given, as by describe(), a file with other content is refused. Throws Error naming the path and a
// remedy.
std::unique_ptr<Brdf> makeMeasured(MaterialParameters& parameters, const std::filesystem::path& folder);

} // namespace relume
