// The light as 6 × size² texels of mean radiance: the form from which relighting starts.
#pragma once

#include "engine/light/environment.h"

namespace relume {

struct LightCube {
    int size = 0;               // texels a side of a face
    std::vector<vec3> radiance; // 6 · size², face by face, row by row; mean over the texel
};

// Samples a prepared environment, turned by `rotation` as in columnShift(), by the footprints of
// engine/light/light_footprint.h. A single bright pixel keeps its irradiance within 2 %, wherever it is. CPU
// twin of shaders/light_sample.comp.
LightCube sampleEnvironment(const Environment& prepared, int size, float rotation);

} // namespace relume
