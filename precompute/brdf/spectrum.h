// From reflectance spectra to linear sRGB.
#pragma once

#include "engine/math/vector.h"

#include <span>
#include <vector>

namespace relume {

// What a spectrum sampled at `wavelengths` (nanometres, rising, reaching from 450 or below to 620 or above)
// is to be multiplied by, sample by sample, to add up to its linear sRGB color. The CIE 1931 2° observer as
// fitted by Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
// Functions", JCGT 2(2), 2013; trapezoid rule; equal-energy light, adapted to the white of sRGB (Bradford): a
// flat spectrum of 1 is (1, 1, 1). Saturated colors outside sRGB come out negative in a channel.
std::vector<vec3> srgbWeights(std::span<const float> wavelengths);

} // namespace relume
