#include "precompute/reference/lobe_sampling.h"

#include "engine/math/tangent_frame.h"

namespace relume {

vec3 drawReflected(vec3 mirror, HashedNumbers& random) {
    const float kind = random.next(), choice = random.next(), turn = random.next();
    if (kind < 0.5f) return onCone(std::sqrt(1 - choice), turn);
    const auto lobe = size_t((kind - 0.5f) * 2 * float(kLobeWidths.size()));
    return tangentFrame(mirror).toWorld(drawLobe(kLobeWidths[lobe], choice, turn));
}

float reflectedDensity(vec3 mirror, vec3 incoming) {
    const float t = 0.5f - 0.5f * glm::dot(incoming, mirror);
    float lobes = 0;
    for (const float width : kLobeWidths) lobes += lobeDensity(width, t);
    return 0.5f * incoming.z / kPi + 0.5f * lobes / float(kLobeWidths.size());
}

} // namespace relume
