// The exact BRDFs behind an asset's materials.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/brdf/brdf.h"

#include <map>

namespace relume {

// Makes each BRDF, which for measured data reads a file, when first asked for it, and keeps it.
class MaterialBrdfs {
  public:
    // Throws as makeBrdf() does.
    std::shared_ptr<const Brdf> of(const AssetMaterial& material);

  private:
    std::map<std::string, std::shared_ptr<const Brdf>> mBrdfs; // by description
};

} // namespace relume
