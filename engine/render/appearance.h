// The materials that are bound to the parts of an asset. A change within a set takes effect in the next draw,
// at no further cost but for programs that are not made yet (ViewOptions::preparesAllMaterials). After a
// change of set, its tuples must be relit first.
#pragma once

#include "engine/transport/asset.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

// The material binding of a part.
struct PartAppearance {
    size_t set = 0;
    // The weight of each material of the set: a blend, whose weights need not sum to 1.
    std::vector<float> weights;
    // Whether the part's material map or vertex colors weigh the materials instead: their channels, divided
    // by their sum, are the weights of the first four. Where the sum is zero, the first material alone shows.
    bool painted = false;

    bool operator==(const PartAppearance&) const = default;
};

using Appearance = std::vector<PartAppearance>; // one per part

// Returns the appearance as baked: each part painted if it can be, else with its first material.
Appearance defaultAppearance(const Asset& asset);

// Returns all names that bindMaterials() knows, in order, each once.
std::vector<std::string> materialNames(const Asset& asset);

// Binds to each part the materials of `blend` that one of its sets holds, weighted by their weights over the
// sum of these. Of several sets, the one that holds most of them is bound; parts without any stay as they
// are. Throws UsageError for a name that no part has, suggesting the nearest, and for a material that is
// bound to no part because it is in no set with the others.
struct WeightedMaterial {
    std::string name;
    float weight = 1;

    bool operator==(const WeightedMaterial&) const = default;
};
void bindMaterials(Appearance& appearance, const Asset& asset, std::span<const WeightedMaterial> blend);

// A layer of view maps that a part shows. Its share is a product of three factors: `weight`; if `channel` is
// 0 to 3, that channel of the paint divided by the sum of its channels; and if `textured`, the base color
// texture and the tint of vertex colors.
struct BoundLayer {
    int layer = 0;
    int channel = -1;
    bool textured = false;
    float weight = 1;
};
// Returns the layers that a part shows; layers of weight 0 are left out.
std::vector<BoundLayer> boundLayers(const AssetPart& part, const PartAppearance& appearance);

// Returns the factors of BoundLayer by paint: each channel divided by the sum over the set's materials, or
// the first material alone if that is zero.
vec4 paintWeights(vec4 paint, size_t materials);

// Returns the share of each of `layers`, per color channel: the product of BoundLayer's factors at a point of
// the part with this uv and vertex color. `set` is the set that is bound.
std::vector<vec3> layerWeights(const AssetPart& part, size_t set, std::span<const BoundLayer> layers, vec2 uv,
                               vec4 color);

} // namespace relume
