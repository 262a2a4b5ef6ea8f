// The points of an asset that an image shows.
#pragma once

#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// All that the pixel centers of an image see, row by row.
struct ViewPoints {
    int width = 0, height = 0;
    std::vector<size_t> pixels; // y · width + x
    std::vector<RayHit> hits;   // RayHit::mesh is the part

    // Of one value a point; zero and alpha 0 elsewhere.
    template <typename Value>
    Image image(const Value& valueOf) const {
        Image image(width, height);
        for (size_t i = 0; i < pixels.size(); i++) image.pixels[pixels[i]] = vec4(valueOf(i), 1);
        return image;
    }
};

// `tracer` has a mesh per part.
ViewPoints viewPoints(const RayTracer& tracer, const Camera& camera, int width, int height);

} // namespace relume
