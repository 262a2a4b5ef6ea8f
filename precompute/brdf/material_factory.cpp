#include "precompute/brdf/material_factory.h"

#include "engine/base/log.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/tabulation.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

// Above this expected error of reflected radiance, nonnegative terms have missed all but a narrow lobe.
constexpr float kMissedError = 0.6f;

bool isNonzero(const BrdfTable& table) {
    return std::ranges::any_of(table.channels, [](const auto& channel) { return !channel.isZero(0); });
}

} // namespace

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
            hasBase = isNonzero(base);
            if (hasBase) {
                tables.push_back(tabulate(*material.brdf, mMapSize, mMapping, value, BrdfPart::Rest));
                tables.push_back(std::move(base));
            }
        }
        if (!hasBase) tables.push_back(tabulate(*material.brdf, mMapSize, mMapping, value));
        set.materials.push_back({material.name, material.brdf->describe().dump(), layer, hasBase});
    }
    set.brdf = factorize(tables, mOptions);
    const bool isMissed = !isTextured && mOptions.method == Factorization::NonNegative &&
                          std::ranges::any_of(expectedErrors(tables, set.brdf), [](const auto& errors) {
                              return errors.back() > kMissedError;
                          });
    return isMissed ? withBases(std::move(set), materials, std::move(tables)) : set;
}

MaterialSet MaterialFactory::withBases(MaterialSet set, const std::vector<NamedMaterial>& materials,
                                       std::vector<BrdfTable> tables) const {
    const size_t layers = tables.size();
    for (const NamedMaterial& material : materials) {
        BrdfTable base =
            tabulate(*material.brdf, mMapSize, mMapping, texelValueOf(mOptions.method), BrdfPart::Base);
        if (isNonzero(base)) tables.push_back(std::move(base));
    }
    if (tables.size() == layers) return set;
    set.brdf = factorize(tables, mOptions);
    set.brdf.layers = int(layers);
    set.brdf.viewMaps.resize(layers * size_t(set.brdf.terms) * set.brdf.mapTexels());
    return set;
}

} // namespace relume
