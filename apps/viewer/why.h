// Why a vertex has the color that it has from where the eye is, in numbers and pictures.
#pragma once

#include "apps/viewer/model.h"
#include "engine/render/tone_map.h"

namespace relume {

// A vertex, an eye, and the light that it is relit by: as it was given, and as it was kept.
struct WhyQuestion {
    std::shared_ptr<const Model> model;
    PartAppearance bound;
    size_t part = 0;
    uint32_t vertex = 0;
    vec3 eye{0};
    LightCube light;
    LightVector kept;
};

// Pictures are of display values: crosses of crossOf() as large as kCrossSide texels a face makes them, and
// maps of kMapWidth.
constexpr int kCrossSide = 64, kMapWidth = 512;

struct Why {
    std::string part;
    uint32_t vertex = 0;
    vec3 position{0};
    std::vector<vec3> tuple; // K
    vec3 radiance{0};        // of the vertex, towards the eye
    float openShare = 0;     // of the hemisphere above it that nothing blocks
    Image visibility;        // cross: white is open, dark blocked, below the horizon transparent
    Image transport;         // cross: what a texel of light adds, the brightest hundredth white
    Image contributions;     // map: the light in gray, and over it what reaches the eye, from red to yellow
};

// Takes a few hundredths of a second; any thread.
Why explain(const WhyQuestion& question);

} // namespace relume
