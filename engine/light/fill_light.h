// The fill: the light without its key, that is, without what shines far brighter than the rest, a sun or
// lamps.
#pragma once

#include "engine/light/light_cube.h"

namespace relume {

// Returns the cube with every channel cut at shared::kMostOfMean times the mean, over all texels, of their
// largest channels. What is cut off is the key. CPU twin of shaders/light_fill.comp, to the bit.
LightCube fillOf(const LightCube& cube);

} // namespace relume
