// Measured BRDFs in the text format of Cornell University's Program of Computer Graphics.
#pragma once

#include "precompute/brdf/isotropic_table.h"

#include <string>
#include <string_view>

namespace relume {

// Parses the text format: "#" begins a comment; first the number of wavelengths, then the wavelengths in
// nanometers over any number of lines, then a line per sample: θi φi θs φs in radians and the BRDF (sr⁻¹) at
// each wavelength. Returns a table of the samples' colors (spectrum.h), taken to be isotropic, reciprocal and
// symmetric about the plane of incidence. Interpolates the logarithms of scattered samples over half and
// difference angles by modified Shepard interpolation (Franke and Nielson, "Smooth interpolation of large
// sets of scattered data", 1980). Negative values and colors count as zero; the log says how many. Throws
// Error naming `name` and the line.
IsotropicTable parseCornell(std::string_view text, const std::string& name);

} // namespace relume
