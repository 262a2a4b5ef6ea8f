#include "engine/render/appearance.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/nearest_name.h"

#include <algorithm>
#include <fmt/ranges.h>

namespace relume {

namespace {

constexpr size_t kPaintChannels = 4;

const AssetMaterial* find(const MaterialSet& set, const std::string& name) {
    const auto found = std::ranges::find(set.materials, name, &AssetMaterial::name);
    return found == set.materials.end() ? nullptr : &*found;
}

// The weights that a blend has in a set, if it has all its materials there.
std::vector<float> weightsIn(const MaterialSet& set, std::span<const WeightedMaterial> blend) {
    std::vector<float> weights(set.materials.size(), 0);
    for (const WeightedMaterial& part : blend) {
        const AssetMaterial* material = find(set, part.name);
        if (!material) return {};
        weights[size_t(material - set.materials.data())] += part.weight;
    }
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
    bool bound = false;
    for (size_t i = 0; i < asset.parts.size(); i++)
        for (size_t set = 0; set < asset.parts[i].sets.size(); set++) {
            std::vector<float> weights = weightsIn(asset.parts[i].sets[set], blend);
            if (weights.empty()) continue;
            appearance[i] = {set, std::move(weights), false};
            bound = true;
            break;
        }
    if (!bound)
        throw UsageError(
            fmt::format("no part has these materials in one set, where they could be blended: bake them as "
                        "one: {{\"set\": […]}}"));
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

} // namespace relume
