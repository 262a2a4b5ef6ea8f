// Metalness and roughness that vary over a surface, as a blend of a few materials in which they are even.
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
// G, metalness in B, linear) times its factors; nothing where that is even, and its mean serves. Roughness is
// blended linearly in its inverse square, within .01 of the least error that two GGX lobes leave of one
// between them: of the lobe, .17 where one is 1.6 times as rough as the other, .28 where twice.
std::optional<MetalRoughnessMap> blendMetalRoughness(const Texture& texture, float metallicFactor,
                                                     float roughnessFactor);

} // namespace relume
