#include "precompute/error/tabulated_brdf.h"

#include <algorithm>

namespace relume {

TabulatedBrdf::TabulatedBrdf(const MaterialSet& set, std::span<const BoundLayer> layers, Factorization method,
                             MaterialBrdfs& brdfs)
    : mSize(set.brdf.size), mMapping(set.brdf.mapping) {
    const auto isBound = [&](int layer) {
        return std::ranges::any_of(layers, [&](const BoundLayer& bound) { return bound.layer == layer; });
    };
    const auto add = [&](const AssetMaterial& material, int layer, BrdfPart part) {
        if (!isBound(layer)) return;
        BrdfTable table = tabulate(*brdfs.of(material), mSize, mMapping, texelValueOf(method), part);
        if (mNearest.empty()) mNearest = nearestDirections(table), mDirections = table.directions.size();
        mLayers.emplace(layer, std::move(table.channels));
    };
    for (const AssetMaterial& material : set.materials) {
        add(material, material.layer, material.hasBase ? BrdfPart::Rest : BrdfPart::All);
        if (material.hasBase) add(material, material.layer + 1, BrdfPart::Base);
    }
}

std::vector<vec3> TabulatedBrdf::lightMap(std::span<const BoundLayer> layers, std::span<const vec3> weights,
                                          vec3 outgoing) const {
    const MapPlace place = placeInMap(mSize, mMapping, outgoing);
    const vec2 w = place.weight;
    const std::array<float, 4> corners = {(1 - w.x) * (1 - w.y), w.x * (1 - w.y), (1 - w.x) * w.y, w.x * w.y};
    std::vector<vec3> directions(mDirections, vec3(0));
    for (size_t i = 0; i < layers.size(); i++) {
        const Channels& channels = mLayers.at(layers[i].layer);
        for (int channel = 0; channel < 3; channel++)
            for (size_t corner = 0; corner < corners.size(); corner++) {
                const float weight = weights[i][channel] * corners[corner];
                if (weight == 0) continue;
                const auto column = channels[size_t(channel)].col(mNearest[size_t(place.texels[corner])]);
                for (size_t d = 0; d < directions.size(); d++)
                    directions[d][channel] += weight * column[Eigen::Index(d)];
            }
    }
    std::vector<vec3> map;
    map.reserve(mNearest.size());
    for (const int direction : mNearest) map.push_back(directions[size_t(direction)]);
    return map;
}

} // namespace relume
