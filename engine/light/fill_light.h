// The fill: the light without its key, that is, without what shines far brighter than the rest, a sun or
// lamps.
#pragma once

#include "engine/light/light_cube.h"
#include "shaders/shared/light.h"

namespace relume {

// The lights that are relit: all of the light, and its fill. The key is the difference.
enum class LightPart : size_t { Whole, Fill };
using shared::kLightParts;

// Returns the cube with every channel cut at shared::kMostOfMean times the mean, over all texels, of their
// largest channels. Texels are not weighted by their solid angles, so that the cut changes a little as a sun
// turns. CPU twin of shaders/light_fill.comp, to the bit.
LightCube fillOf(const LightCube& cube);

} // namespace relume
