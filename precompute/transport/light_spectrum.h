// The mean spectrum of light, by which errors of transport coefficients are weighted.
#pragma once

#include <vector>

namespace relume {

// Returns a weight of the amplitude of errors per coefficient face · F² + y · F + x of a cube: 1 for a face's
// average, falling with the wavelet's level as the mean amplitude of indoor and outdoor environments does,
// raised to 0.7, since small lamps and suns have more fine detail than the mean.
std::vector<float> lightSpectrum(int faceSize);

} // namespace relume
