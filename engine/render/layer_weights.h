// Weights of bound layers at a point of the surface.
#pragma once

#include "engine/render/appearance.h"

namespace relume {

// Returns the share of each of `layers`, per color channel: the product of BoundLayer's factors at a point of
// the part with this uv and vertex color. `set` is the set that is bound.
std::vector<vec3> layerWeights(const AssetPart& part, size_t set, std::span<const BoundLayer> layers, vec2 uv,
                               vec4 color);

} // namespace relume
