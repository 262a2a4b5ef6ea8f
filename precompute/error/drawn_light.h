// A light as it is drawn: quantized entries of the whole light and of its fill (engine/light/fill_light.h).
#pragma once

#include "engine/light/fill_light.h"
#include "engine/light/light_vector.h"

#include <array>
#include <span>

namespace relume {

// The whole light or its fill, of F texels a side of a face.
struct DrawnCube {
    LightCube cube;
    LightVector entries; // of the cube, selected and quantized
};

using DrawnLight = std::array<DrawnCube, kLightParts>; // by LightPart

// Returns the light of a cube.
DrawnLight drawnLight(LightCube cube, const LightSelection& selection);

} // namespace relume
