#include "engine/math/tangent_frame.h"

namespace relume {

TangentFrame tangentFrame(vec3 n) {
    const float above = n.y + 1.0f;
    const vec3 tangent(above * above + n.z * n.z - n.x * n.x, -2.0f * n.x * above, -2.0f * n.x * n.z);
    const float squared = glm::dot(tangent, tangent);
    // The length of `tangent` is 2 (1 + n.y), so near the pole n.y = -1 it is lost in rounding.
    vec3 s = squared > 1e-10f ? tangent / std::sqrt(squared) : vec3(1, 0, 0);
    s = glm::normalize(s - glm::dot(s, n) * n);
    return {s, glm::cross(n, s), n};
}

TangentFrame lowerTangentFrame(vec3 n) {
    constexpr vec3 kMirror(1, -1, 1);
    return tangentFrame(n, kMirror * tangentFrame(kMirror * n).s);
}

TangentFrame tangentFrame(vec3 n, vec3 tangent) {
    vec3 s = tangent - glm::dot(tangent, n) * n;
    const float squared = glm::dot(s, s);
    if (!(squared > 1e-10f)) return tangentFrame(n);
    s /= std::sqrt(squared);
    return {s, glm::cross(n, s), n};
}

} // namespace relume
