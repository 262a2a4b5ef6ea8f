// Measured BRDFs in the text format of Cornell University's Program of Computer Graphics.
#pragma once

#include "precompute/brdf/isotropic_table.h"

#include <string>
#include <string_view>

namespace relume {

// The format: "#" begins a comment; the number of wavelengths; the wavelengths in nanometres, over as many
// lines as they take; then a line per sample: θi φi θs φs in radians and the BRDF (sr⁻¹) at each wavelength.
// Returns a table of the scattered samples' colors (spectrum.h), which is isotropic, reciprocal and
// symmetric about the plane of incidence, as the samples are taken to be: between samples, modified Shepard
// interpolation (Franke and Nielson, "Smooth interpolation of large sets of scattered data", 1980) of the
// colors' logarithms over half and difference angles. Negative values and colors count as zero; the log
// says how many. Throws Error naming `name` and the line.
IsotropicTable parseCornell(std::string_view text, const std::string& name);

} // namespace relume
