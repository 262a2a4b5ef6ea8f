#include "precompute/brdf/material_brdfs.h"

namespace relume {

std::shared_ptr<const Brdf> MaterialBrdfs::of(const AssetMaterial& material) {
    std::shared_ptr<const Brdf>& brdf = mBrdfs[material.description];
    if (!brdf) brdf = makeBrdf(material.description);
    return brdf;
}

} // namespace relume
