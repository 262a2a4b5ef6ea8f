// Makes factored material sets from the text of a part's materials.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/brdf/factorization.h"
#include "precompute/brdf/material_list.h"

#include <map>
#include <tuple>

namespace relume {

// Factors equal materials once, regardless of their names and of how many parts use them.
class MaterialFactory {
  public:
    MaterialFactory(const FactorizationOptions& options, int mapSize, DiskMapping mapping)
        : mOptions(options), mMapSize(mapSize), mMapping(mapping) {}

    // Returns the sets that readMaterials() yields, factored, without transport. If the part has a base color
    // texture, BRDFs with a base are split into base and rest; the log names those without, in which the
    // texture does not show.
    std::vector<MaterialSet> make(const std::string& material, const std::filesystem::path& folder,
                                  bool isTextured);

    size_t factored() const { return mFactored.size(); } // number of distinct sets factored

  private:
    MaterialSet factor(const std::vector<NamedMaterial>& materials, bool isTextured);
    MaterialSet factorAnew(const std::vector<NamedMaterial>& materials, bool isTextured) const;
    // Factors the bases along with the tables, so that light maps represent them, and drops their view maps.
    // All nonnegative terms go to the peaks of a lobe that is too narrow for its maps, and the rest of the
    // reflected light would be in none.
    MaterialSet withBases(MaterialSet set, const std::vector<NamedMaterial>& materials,
                          std::vector<BrdfTable> tables) const;

    FactorizationOptions mOptions;
    int mMapSize;
    DiskMapping mMapping;
    std::map<std::tuple<std::string, std::filesystem::path, bool>, std::vector<MaterialSet>> mKnown;
    std::map<std::pair<std::vector<std::string>, bool>, MaterialSet> mFactored; // by the BRDFs' descriptions
};

} // namespace relume
