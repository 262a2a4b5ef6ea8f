#include "precompute/error/view_points.h"

namespace relume {

ViewPoints viewPoints(const RayTracer& tracer, const Camera& camera, int width, int height) {
    ViewPoints points{width, height, {}, {}};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (const auto hit = tracer.intersect(camera.eye, camera.pixelDirection(x, y, width, height))) {
                points.pixels.push_back(size_t(y) * size_t(width) + size_t(x));
                points.hits.push_back(*hit);
            }
    return points;
}

} // namespace relume
