// The materials that are bound to the parts of an asset. Within a set a change costs nothing but itself: the
// next draw has it. Another set's tuples must be relit first.
#pragma once

#include "engine/transport/asset.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relume {

struct PartAppearance {
    size_t set = 0;
    // How much of each material of the set: a blend, whatever the weights sum to.
    std::vector<float> weights;
    // By the part's material map or vertex colors instead: the weights of the first four materials there,
    // over their sum; where that is zero, the first material alone.
    bool painted = false;

    bool operator==(const PartAppearance&) const = default;
};

using Appearance = std::vector<PartAppearance>; // one per part

// Every part as it was baked to be: painted where it is, else in its first material.
Appearance defaultAppearance(const Asset& asset);

// All names that bindMaterials() knows, in order, each once.
std::vector<std::string> materialNames(const Asset& asset);

// Binds to every part those of the materials that one of its sets holds, blended by their weights over the
// sum of these; of several sets, the one that holds the most. Parts without any stay as they are. Throws
// UsageError for a name that no part has, naming the nearest, and for a material that is bound to no part
// because its set does not hold the others.
struct WeightedMaterial {
    std::string name;
    float weight = 1;

    bool operator==(const WeightedMaterial&) const = default;
};
void bindMaterials(Appearance& appearance, const Asset& asset, std::span<const WeightedMaterial> blend);

// A layer of view maps that a part shows, and how much of it, is a product of three: `weight`; where
// `channel` is 0 to 3, that channel of the paint over the sum of its channels; and where `textured`, the base
// color texture.
struct BoundLayer {
    int layer = 0;
    int channel = -1;
    bool textured = false;
    float weight = 1;
};
std::vector<BoundLayer> boundLayers(const AssetPart& part, const PartAppearance& appearance);

// The factors of BoundLayer from paint: channel / sum over the set's materials, or the first alone.
vec4 paintWeights(vec4 paint, size_t materials);

} // namespace relume
