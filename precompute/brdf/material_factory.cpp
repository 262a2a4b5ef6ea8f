#include "precompute/brdf/material_factory.h"

#include "engine/base/log.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace relume {

std::vector<MaterialSet> MaterialFactory::make(const std::string& material,
                                               const std::filesystem::path& folder, bool isTextured) {
    const auto [known, isNew] = mKnown.try_emplace({material, folder, isTextured});
    if (!isNew) return known->second;
    for (const std::vector<NamedMaterial>& materials : readMaterials(material, folder))
        known->second.push_back(factor(materials, isTextured));
    for (const MaterialSet& set : known->second)
        for (const AssetMaterial& made : set.materials)
            if (isTextured && !made.hasBase)
                log(LogLevel::Warning, fmt::format("{}: has no base color that a texture could multiply; "
                                                   "the texture does not show in it",
                                                   made.name));
    return known->second;
}

MaterialSet MaterialFactory::factor(const std::vector<NamedMaterial>& materials, bool isTextured) {
    std::vector<std::string> descriptions;
    for (const NamedMaterial& material : materials) descriptions.push_back(material.brdf->describe().dump());
    const auto [known, isNew] = mFactored.try_emplace({descriptions, isTextured});
    MaterialSet& set = known->second;
    if (isNew) set = factorAnew(materials, isTextured);
    MaterialSet named = set;
    for (size_t i = 0; i < materials.size(); i++) named.materials[i].name = materials[i].name;
    return named;
}

MaterialSet MaterialFactory::factorAnew(const std::vector<NamedMaterial>& materials, bool isTextured) const {
    const TexelValue value = texelValueOf(mOptions.method);
    MaterialSet set;
    std::vector<BrdfTable> tables;
    for (const NamedMaterial& material : materials) {
        const int layer = int(tables.size());
        bool hasBase = false;
        if (isTextured) {
            BrdfTable base = tabulate(*material.brdf, mMapSize, mMapping, value, BrdfPart::Base);
            hasBase =
                std::ranges::any_of(base.channels, [](const auto& channel) { return !channel.isZero(0); });
            if (hasBase) {
                tables.push_back(tabulate(*material.brdf, mMapSize, mMapping, value, BrdfPart::Rest));
                tables.push_back(std::move(base));
            }
        }
        if (!hasBase) tables.push_back(tabulate(*material.brdf, mMapSize, mMapping, value));
        set.materials.push_back({material.name, material.brdf->describe().dump(), layer, hasBase});
    }
    set.brdf = factorize(tables, mOptions);
    return set;
}

} // namespace relume
