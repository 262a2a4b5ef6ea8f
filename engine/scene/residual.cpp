#include "engine/scene/residual.h"

#include <algorithm>
#include <cmath>

namespace relume {

float concentrationOf(const SphereKernel& kernel) {
    constexpr size_t kRings = shared::kSphereRings;
    // The first row is of mirror directions 1.9° from the view direction; its frequency 0 is the mean over
    // azimuths about that direction.
    double peak = 0, sum = 0, all = 0;
    for (size_t ring = 0; ring < kRings; ring++) {
        const vec3 value = kernel.values[ring];
        const double gray = double(value.x + value.y + value.z);
        const double solidAngle = std::sin(double(kPi) * (double(ring) + 0.5) / double(kRings));
        peak = std::max(peak, gray);
        sum += gray * solidAngle, all += solidAngle;
    }
    return sum > 0 ? float(std::max(peak * all / sum, 1.0)) : 1;
}

} // namespace relume
