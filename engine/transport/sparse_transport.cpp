#include "engine/transport/sparse_transport.h"

#include <cmath>

namespace relume {

ivec3 quantiseCoefficient(vec3 value, float scale) {
    if (!(scale > 0)) return ivec3(0);
    const auto quantise = [&](float component, int maximum) {
        const float steps = component / scale * float(maximum);
        return int(steps < 0 ? std::ceil(steps - 0.5f) : std::floor(steps + 0.5f));
    };
    return {quantise(value.x, kRedMaximum), quantise(value.y, kGreenMaximum),
            quantise(value.z, kBlueMaximum)};
}

} // namespace relume
