#include "engine/render/heat_color.h"

namespace relume {

vec3 heatColor(float heat) {
    const float h = 4 * glm::clamp(heat, 0.0f, 1.0f);
    const auto share = [&](float from) { return glm::clamp(h - from, 0.0f, 1.0f); };
    vec3 c = glm::mix(vec3(0), vec3(0.02f, 0.03f, 0.35f), share(0));
    c = glm::mix(c, vec3(0.5f, 0.02f, 0.25f), share(1));
    c = glm::mix(c, vec3(1, 0.3f, 0.01f), share(2));
    return glm::mix(c, vec3(1, 1, 0.6f), share(3));
}

} // namespace relume
