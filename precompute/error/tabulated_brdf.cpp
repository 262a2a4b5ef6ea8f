#include "precompute/error/tabulated_brdf.h"

#include "engine/base/check.h"

namespace relume {

TabulatedBrdf::TabulatedBrdf(const MaterialSet& set, Factorization method, MaterialBrdfs& brdfs)
    : mSize(set.brdf.size), mMapping(set.brdf.mapping) {
    const auto add = [&](const Brdf& brdf, BrdfPart part) {
        BrdfTable table = tabulate(brdf, mSize, mMapping, texelValueOf(method), part);
        if (mNearest.empty()) mNearest = nearestDirections(table);
        mLayers.push_back({std::move(table.channels)});
    };
    for (const AssetMaterial& material : set.materials) {
        RELUME_CHECK_EQ(size_t(material.layer), mLayers.size());
        const std::shared_ptr<const Brdf> brdf = brdfs.of(material);
        add(*brdf, material.hasBase ? BrdfPart::Rest : BrdfPart::All);
        if (material.hasBase) add(*brdf, BrdfPart::Base);
    }
}

std::vector<vec3> TabulatedBrdf::lightMap(std::span<const WornLayer> layers, std::span<const vec3> weights,
                                          vec3 outgoing) const {
    const MapPlace place = placeInMap(mSize, mMapping, outgoing);
    const vec2 w = place.weight;
    const std::array<float, 4> corners = {(1 - w.x) * (1 - w.y), w.x * (1 - w.y), (1 - w.x) * w.y, w.x * w.y};
    std::vector<vec3> directions(size_t(mLayers.front().channels[0].rows()), vec3(0));
    for (size_t i = 0; i < layers.size(); i++) {
        const Layer& layer = mLayers[size_t(layers[i].layer)];
        for (int channel = 0; channel < 3; channel++)
            for (size_t corner = 0; corner < corners.size(); corner++) {
                const float weight = weights[i][channel] * corners[corner];
                if (weight == 0) continue;
                const auto column =
                    layer.channels[size_t(channel)].col(mNearest[size_t(place.texels[corner])]);
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
