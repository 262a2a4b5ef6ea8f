// From the text of a part's materials to factored sets.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/material_list.h"

#include <map>
#include <tuple>

namespace relume {

// Factors equal materials once, however many parts have them and whatever they are called.
class MaterialFactory {
  public:
    MaterialFactory(const FactorizationOptions& options, int mapSize, DiskMapping mapping)
        : mOptions(options), mMapSize(mapSize), mMapping(mapping) {}

    // The sets that readMaterials() gives, without transport. For a part with a texture of base colors,
    // BRDFs that have a base are split into it and the rest; the log names those without, in which the
    // texture does not show.
    std::vector<MaterialSet> make(const std::string& material, const std::filesystem::path& folder,
                                  bool isTextured);

    size_t factored() const { return mFactored.size(); } // how many sets were factored, each once

  private:
    MaterialSet factor(const std::vector<NamedMaterial>& materials, bool isTextured);
    MaterialSet factorAnew(const std::vector<NamedMaterial>& materials, bool isTextured) const;

    FactorizationOptions mOptions;
    int mMapSize;
    DiskMapping mMapping;
    std::map<std::tuple<std::string, std::filesystem::path, bool>, std::vector<MaterialSet>> mKnown;
    std::map<std::pair<std::vector<std::string>, bool>, MaterialSet> mFactored; // by what the BRDFs describe
};

} // namespace relume
