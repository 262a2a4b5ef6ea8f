// The points of an asset that are visible in an image.
#pragma once

#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "precompute/visibility/ray_tracer.h"

namespace relume {

// The points at pixel centers, in row order.
struct ViewPoints {
    int width = 0, height = 0;
    std::vector<size_t> pixels; // y · width + x
    std::vector<RayHit> hits;   // RayHit::mesh is the part

    // Returns an image of one value per point; zero with alpha 0 elsewhere.
    template <typename Value>
    Image image(const Value& valueOf) const {
        Image image(width, height);
        for (size_t i = 0; i < pixels.size(); i++) image.pixels[pixels[i]] = vec4(valueOf(i), 1);
        return image;
    }
};

// Finds the points; `tracer` has one mesh per part.
ViewPoints viewPoints(const RayTracer& tracer, const Camera& camera, int width, int height);

} // namespace relume
