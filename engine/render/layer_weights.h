// How much of each bound layer shows at a place of the surface.
#pragma once

#include "engine/render/appearance.h"

namespace relume {

// The factors of BoundLayer multiplied, per color channel: of each of `layers`, of set `set` of the part,
// where the mesh's uv and vertex color are these.
std::vector<vec3> layerWeights(const AssetPart& part, size_t set, std::span<const BoundLayer> layers, vec2 uv,
                               vec4 color);

} // namespace relume
