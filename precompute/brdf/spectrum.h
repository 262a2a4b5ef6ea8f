// Conversion of reflectance spectra to linear sRGB.
#pragma once

#include "engine/math/vector.h"

#include <span>
#include <vector>

namespace relume {

// Returns the weights by which a spectrum's samples at `wavelengths` are multiplied to sum to its linear sRGB
// color. Wavelengths are in nanometers, ascending, from 450 or below to 620 or above. CIE 1931 2° observer as
// fitted by Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions", JCGT 2(2), 2013; trapezoid rule; equal-energy illuminant adapted to the white of sRGB
// (Bradford), so a flat spectrum of 1 is (1, 1, 1). Colors outside sRGB have negative channels.
std::vector<vec3> srgbWeights(std::span<const float> wavelengths);

} // namespace relume
