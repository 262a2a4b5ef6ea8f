#include "engine/render/layer_weights.h"

namespace relume {

std::vector<vec3> layerWeights(const AssetPart& part, size_t set, std::span<const BoundLayer> layers, vec2 uv,
                               vec4 color) {
    std::vector<vec3> weights;
    for (const BoundLayer& layer : layers) {
        vec3 weight(layer.weight);
        if (layer.channel >= 0) {
            const vec4 paint = part.materialMap ? sample(*part.materialMap, uv) : color;
            weight *= paintWeights(paint, part.sets[set].materials.size())[layer.channel];
        }
        if (layer.textured && part.baseColor) weight *= vec3(sample(*part.baseColor, uv));
        if (layer.textured && part.tintedByColors) weight *= vec3(color);
        weights.push_back(weight);
    }
    return weights;
}

} // namespace relume
