// Metalness and roughness that vary over a surface, expressed as a blend of a few uniform materials.
#pragma once

#include "engine/scene/texture.h"

#include <optional>

namespace relume {

// A material of the blend.
struct MetalRoughness {
    float metallic = 0, roughness = 0; // in [0, 1]
};

struct MetalRoughnessMap {
    std::vector<MetalRoughness> nodes; // 2 to 4
    Texture weights;                   // of the nodes, in R, G, B and A: they sum to 1 but for rounding
};

// Returns the nodes and weights whose blends come nearest to a glTF metallic-roughness texture (roughness in
// G, metalness in B, linear) times its factors; none if the result is uniform, so that its mean serves.
// Roughness is blended linearly in its inverse square, within .01 of the least error that two GGX lobes leave
// of one between them: .17 of the lobe if one is 1.6 times as rough as the other, .28 if twice.
std::optional<MetalRoughnessMap> blendMetalRoughness(const Texture& texture, float metallicFactor,
                                                     float roughnessFactor);

} // namespace relume
