#include "engine/import/ground.h"

#include "engine/base/check.h"
#include "engine/import/builtin_mesh.h"

#include <algorithm>

namespace relume {

Mesh makeGround(const Bounds& object, const GroundOptions& options) {
    const vec3 extent = object.extent();
    const float largest = std::max({extent.x, extent.y, extent.z});
    RELUME_CHECK(largest > 0 && options.extent > 0);
    Mesh ground = makePlane(options.extent * largest, options.tessellation);
    const vec3 center(object.center().x, object.low.y, object.center().z);
    for (vec3& position : ground.positions) position += center;
    return ground;
}

} // namespace relume
