// Explains in numbers and pictures why a vertex has its color as seen from the eye.
#pragma once

#include "apps/viewer/model.h"
#include "engine/render/tone_map.h"

namespace relume {

// A vertex, an eye, and the light, as given and as the selected entries.
struct VertexQuestion {
    std::shared_ptr<const Model> model;
    PartAppearance bound;
    size_t part = 0;
    uint32_t vertex = 0;
    vec3 eye{0};
    LightCube light;
    LightVector selected;
};

// Sizes of pictures: faces of crosses by crossOf() have at most kCrossSide pixels per side; maps are
// kMapWidth wide.
constexpr int kCrossSide = 64, kMapWidth = 512;

// The answer to a VertexQuestion.
struct VertexExplanation {
    std::string part;
    uint32_t vertex = 0;
    vec3 position{0};
    std::vector<vec3> tuple; // K
    vec3 radiance{0};        // of the vertex, towards the eye
    float openShare = 0;     // share of the hemisphere above the vertex that is unoccluded
    Image visibility;        // cross: white is unoccluded, dark is occluded, below the horizon is transparent
    Image transport;         // cross: contribution per texel of light, scaled to its 99th percentile
    Image contributions;     // map: the light in gray, and over it what reaches the eye, from red to yellow
};

// Answers in a few hundredths of a second, on any thread.
VertexExplanation explainVertex(const VertexQuestion& question);

} // namespace relume
