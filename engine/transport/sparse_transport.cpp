#include "engine/transport/sparse_transport.h"

#include <cmath>

namespace relume {

uint32_t packCoefficient(ivec3 q) {
    return (uint32_t(q.x) & 0x7ffu) | (uint32_t(q.y) & 0x7ffu) << 11 | (uint32_t(q.z) & 0x3ffu) << 22;
}

ivec3 unpackCoefficient(uint32_t packed) {
    const auto signExtend = [](uint32_t bits, int width) {
        return int32_t(bits << (32 - width)) >> (32 - width);
    };
    return {signExtend(packed, 11), signExtend(packed >> 11, 11), signExtend(packed >> 22, 10)};
}

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
