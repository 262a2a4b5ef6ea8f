#include "engine/render/appearance.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace relume {

namespace {

constexpr size_t kPaintChannels = 4;

// Returns the number of the blend's materials that a set holds.
size_t countHeld(const MaterialSet& set, std::span<const WeightedMaterial> blend) {
    return size_t(std::ranges::count_if(blend, [&](const WeightedMaterial& material) {
        return std::ranges::find(set.materials, material.name, &AssetMaterial::name) != set.materials.end();
    }));
}

// Returns the weights of a set's materials in the blend, divided by their sum; empty if that is zero.
std::vector<float> weightsIn(const MaterialSet& set, std::span<const WeightedMaterial> blend) {
    std::vector<float> weights(set.materials.size(), 0);
    float sum = 0;
    for (size_t m = 0; m < weights.size(); m++)
        for (const WeightedMaterial& material : blend)
            if (material.name == set.materials[m].name) sum += weights[m] = material.weight;
    if (!(sum > 0)) return {};
    for (float& weight : weights) weight /= sum;
    return weights;
}

} // namespace

Appearance defaultAppearance(const Asset& asset) {
    Appearance appearance;
    for (const AssetPart& part : asset.parts) {
        std::vector<float> weights(part.sets[0].materials.size(), 0);
        weights[0] = 1;
        appearance.push_back({0, std::move(weights), part.isPainted()});
    }
    return appearance;
}

std::vector<std::string> materialNames(const Asset& asset) {
    std::vector<std::string> names;
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            for (const AssetMaterial& material : set.materials)
                if (std::ranges::find(names, material.name) == names.end()) names.push_back(material.name);
    return names;
}

void bindMaterials(Appearance& appearance, const Asset& asset, std::span<const WeightedMaterial> blend) {
    RELUME_CHECK_EQ(appearance.size(), asset.parts.size());
    const std::vector<std::string> names = materialNames(asset);
    for (const WeightedMaterial& part : blend)
        if (std::ranges::find(names, part.name) == names.end())
            throw UsageError(
                fmt::format("no part has a material \"{}\"; did you mean \"{}\"? There are {}", part.name,
                            nearestName(part.name, std::vector<std::string_view>(names.begin(), names.end())),
                            fmt::join(names, ", ")));
    std::vector<std::string> bound;
    for (size_t i = 0; i < asset.parts.size(); i++) {
        const std::vector<MaterialSet>& sets = asset.parts[i].sets;
        const auto set = std::ranges::max_element(
            sets, {}, [&](const MaterialSet& each) { return countHeld(each, blend); });
        std::vector<float> weights = weightsIn(*set, blend);
        if (weights.empty()) continue;
        appearance[i] = {size_t(set - sets.begin()), std::move(weights), false};
        for (const AssetMaterial& material : set->materials) bound.push_back(material.name);
    }
    for (const WeightedMaterial& material : blend)
        if (material.weight > 0 && std::ranges::find(bound, material.name) == bound.end())
            throw UsageError(fmt::format(
                "\"{}\" is in no set with the others, where they could be blended: bake them as one: "
                "{{\"set\": […]}}",
                material.name));
}

std::vector<BoundLayer> boundLayers(const AssetPart& part, const PartAppearance& appearance) {
    const MaterialSet& set = part.sets.at(appearance.set);
    std::vector<BoundLayer> layers;
    for (size_t m = 0; m < set.materials.size(); m++) {
        const AssetMaterial& material = set.materials[m];
        BoundLayer layer{material.layer};
        if (appearance.painted) {
            if (m >= kPaintChannels) break;
            layer.channel = int(m);
        } else {
            layer.weight = appearance.weights.at(m);
        }
        if (layer.weight == 0) continue;
        layers.push_back(layer);
        if (!material.hasBase) continue;
        layer.layer++;
        layer.textured = true;
        layers.push_back(layer);
    }
    return layers;
}

vec4 paintWeights(vec4 paint, size_t materials) {
    for (size_t m = materials; m < kPaintChannels; m++) paint[int(m)] = 0;
    const float sum = paint.x + paint.y + paint.z + paint.w;
    return sum > 0 ? paint / sum : vec4(1, 0, 0, 0);
}

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
