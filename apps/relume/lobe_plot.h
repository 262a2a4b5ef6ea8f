// Reflection lobes, true and approximated, in the plane of incidence.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "precompute/brdf/brdf.h"

#include <string>

namespace relume {

// SVG: a polar plot of f cosθo (luminance) over the outgoing angle for each of four incoming angles, in the
// plane through the normal and s. Solid: the BRDF; dashed: its terms, whose negative values are drawn as 0.
std::string drawLobes(const Brdf& brdf, const FactoredBrdf& factored, const std::string& title);

} // namespace relume
