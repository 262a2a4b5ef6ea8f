#include "engine/light/stroke.h"

#include "engine/base/check.h"
#include "engine/light/cap.h"
#include "engine/math/cubemap.h"

namespace relume {

shared::LightCap makeStrokeCap(const Stroke& stroke, int size) {
    RELUME_CHECK(stroke.opacity >= 0 && stroke.opacity <= 1);
    shared::LightCap cap = makeCap(stroke.direction, stroke.angularRadius, stroke.softness, size);
    cap.amount = stroke.opacity;
    cap.radiance = stroke.radiance;
    return cap;
}

void paintStroke(LightCube& cube, const Stroke& stroke) {
    const shared::LightCap cap = makeStrokeCap(stroke, cube.size);
    forEachTexel(cube.size, [&](int face, int x, int y, size_t texel) {
        const float share = cap.amount * capCoverage(cap, face, x, y, cube.size);
        cube.radiance[texel] = glm::mix(cube.radiance[texel], stroke.radiance, share);
    });
}

} // namespace relume
