// How much of each worn layer shows at a place of the surface.
#pragma once

#include "engine/render/appearance.h"

namespace relume {

// The factors of WornLayer multiplied, per colour channel: of each of `layers`, of set `set` of the part,
// where the mesh's uv and vertex colour are these.
std::vector<vec3> layerWeights(const AssetPart& part, size_t set, std::span<const WornLayer> layers, vec2 uv,
                               vec4 color);

} // namespace relume
