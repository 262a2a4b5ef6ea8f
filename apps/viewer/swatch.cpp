#include "apps/viewer/swatch.h"

#include "engine/light/environment.h"
#include "engine/math/disk_map.h"
#include "engine/math/tangent_frame.h"
#include "precompute/brdf/brdf.h"

#include <cmath>

namespace relume {

namespace {

constexpr int kLightColumns = 48; // of the map that lights it

struct Ray {
    vec3 direction, energy;
};

std::vector<Ray> skyRays() {
    const Environment sky = prepareForSampling(makeSky(), kLightColumns);
    std::vector<Ray> rays;
    for (int y = 0; y < sky.height; y++) {
        const float pixel = 2 * kPi / float(sky.width); // wide and high, in radians
        const float solidAngle = pixel * 2 * std::sin(pixel / 2) * std::sin(pixel * (float(y) + 0.5f));
        for (int x = 0; x < sky.width; x++)
            rays.push_back({sky.direction(float(x) + 0.5f, float(y) + 0.5f),
                            sky.radiance[size_t(y) * size_t(sky.width) + size_t(x)] * solidAngle});
    }
    return rays;
}

} // namespace

Image renderSwatch(const std::string& description, int size) {
    static const std::vector<Ray> rays = skyRays();
    const std::unique_ptr<Brdf> brdf = makeBrdf(description);
    Image image(size, size);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const vec2 place = vec2(2 * float(x) + 1, -2 * float(y) - 1) / float(size) + vec2(-1, 1);
            const float inside = 1 - glm::dot(place, place);
            if (inside <= 0) continue;
            const TangentFrame frame = tangentFrame(vec3(place, std::sqrt(inside)));
            const vec3 outgoing = liftAboveHorizon(frame.toLocal(vec3(0, 0, 1)));
            vec3 sum(0);
            for (const Ray& ray : rays) {
                const vec3 incoming = frame.toLocal(ray.direction);
                if (incoming.z > 0) sum += brdf->evaluate(incoming, outgoing) * incoming.z * ray.energy;
            }
            image.at(x, y) = vec4(sum, 1);
        }
    return image;
}

} // namespace relume
