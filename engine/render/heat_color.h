// Numbers as colors. GLSL twin: shaders/compare.frag.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// From black (0) over blue, purple and orange to yellow (1 and more); linear.
vec3 heatColor(float heat);

} // namespace relume
