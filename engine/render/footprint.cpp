#include "engine/render/footprint.h"

namespace relume {

Footprint footprintOf(const Bounds& bounds, const mat4& clipFromWorld) {
    Footprint footprint;
    for (int corner = 0; corner < 8; corner++) {
        const vec3 point(corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                         corner & 4 ? bounds.high.z : bounds.low.z);
        const vec4 clip = clipFromWorld * vec4(point, 1);
        if (!(clip.z >= 0 && clip.w > 0)) return {false, vec2(-1), vec2(1)};
        const vec2 place = vec2(clip) / clip.w;
        footprint.low = glm::min(footprint.low, place);
        footprint.high = glm::max(footprint.high, place);
    }
    return footprint;
}

} // namespace relume
