// A color scale for numbers. GLSL twin: shaders/compare.frag.
#pragma once

#include "engine/math/vector.h"

namespace relume {

// Returns a linear color: from black (0) over blue, purple and orange to yellow (1 and more).
vec3 heatColor(float heat);

} // namespace relume
