#include "precompute/reference/pixel_hits.h"

#include <array>

namespace relume {

void findPixelHits(const RayTracer& surfaces, const Camera& camera, ivec2 pixel, ivec2 size,
                   std::span<std::optional<RayHit>> hits) {
    std::array<vec3, kMostSamples> weights;
    for (size_t i = 0; i < hits.size(); i++) {
        const vec2 place = vec2(pixel) + samplePosition(int(hits.size()), int(i));
        hits[i] = surfaces.intersect(camera.eye, camera.directionAt(place, size.x, size.y));
        if (hits[i]) weights[i] = hits[i]->weights;
    }
    for (auto& hit : hits) {
        vec3 sum(0);
        float count = 0;
        for (size_t i = 0; i < hits.size(); i++)
            if (isSameTriangle(hit, hits[i])) sum += weights[i], count++;
        if (hit) hit->weights = sum / count;
    }
}

std::unique_ptr<RayTracer> tracerWithout(const std::optional<GroundFade>& ground, vec3 eye,
                                         std::vector<const Mesh*> meshes) {
    if (!ground || !ground->isHiddenFrom(eye)) return nullptr;
    static const Mesh kNothing;
    meshes[ground->part] = &kNothing;
    return std::make_unique<RayTracer>(meshes);
}

} // namespace relume
