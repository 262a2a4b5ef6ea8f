#include "apps/viewer/swatch.h"

#include "engine/light/light_cube.h"
#include "engine/math/cubemap.h"
#include "engine/math/disk_map.h"
#include "engine/math/tangent_frame.h"
#include "precompute/brdf/brdf.h"

#include <cmath>

namespace relume {

namespace {

constexpr int kLightSize = 12; // texels per side of the cube that lights it

struct Ray {
    vec3 direction, energy;
};

std::vector<Ray> skyRays() {
    const LightCube sky = sampleEnvironment(prepareForSampling(makeSky()), kLightSize, 0);
    std::vector<Ray> rays;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < kLightSize; y++)
            for (int x = 0; x < kLightSize; x++)
                rays.push_back({cubeTexelDirection(face, x, y, kLightSize),
                                sky.radiance[size_t(cubeTexelIndex(face, x, y, kLightSize))] *
                                    cubeTexelSolidAngle(x, y, kLightSize)});
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
