// How much light there is at each scale: what an error of a transport coefficient matters.
#pragma once

#include <vector>

namespace relume {

// Weight per coefficient of a cube, face·F² + y·F + x, of the amplitude of an error: 1 for a face's average,
// falling with the wavelet's level as the amplitudes of environments do, indoors and outdoors, to the power
// 0.7: lamps and suns are small, and so the small scales of some light are stronger than the mean's.
std::vector<float> lightSpectrum(int faceSize);

} // namespace relume
