#include "precompute/bake/sketch.h"

#include "precompute/bake/bake_plan.h"
#include "precompute/residual/residuals.h"

namespace relume {

Asset makeSketch(const vk::Device& device, Scene scene) {
    // Terms are not used, and made as cheaply as possible.
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.factorization.terms = 1;
    options.mapSize = 4;
    BakeObserver silent;
    Asset asset = std::move(planBake(device, std::move(scene), options, silent).asset);
    makeResiduals(asset, true);
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) {
            auto& rows = std::get<SparseTransport>(set.transport);
            rows.rowStarts.assign(rows.rows() + 1, 0);
            rows.scales.assign(rows.rows(), 0);
        }
    return asset;
}

} // namespace relume
