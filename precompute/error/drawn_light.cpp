#include "precompute/error/drawn_light.h"

namespace relume {

DrawnLight drawnLight(LightCube cube, const LightSelection& selection) {
    LightCube fill = fillOf(cube);
    LightVector whole = makeLightVector(cube, selection), ofFill = makeLightVector(fill, selection);
    return {DrawnCube{std::move(cube), std::move(whole)}, DrawnCube{std::move(fill), std::move(ofFill)}};
}

} // namespace relume
