// A cache of the exact BRDFs of an asset's materials.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/brdf/brdf.h"

#include <map>

namespace relume {

// Makes each BRDF on first use (for measured data this reads a file) and keeps it.
class MaterialBrdfs {
  public:
    // Throws as makeBrdf() does.
    std::shared_ptr<const Brdf> of(const AssetMaterial& material);

  private:
    std::map<std::string, std::shared_ptr<const Brdf>> mBrdfs; // by description
};

} // namespace relume
