#include "apps/relume/appearance_arguments.h"

#include "engine/base/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

// Parses NAME=WEIGHT, or NAME if there is no "=" or the whole text is a material's name.
WeightedMaterial parse(const std::string& text, const std::vector<std::string>& names) {
    const size_t equals = text.rfind('=');
    if (equals == std::string::npos || std::ranges::find(names, text) != names.end()) return {text};
    WeightedMaterial material{text.substr(0, equals)};
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data() + equals + 1, end, material.weight);
    if (failure != std::errc() || rest != end || !(material.weight >= 0 && material.weight <= 1e6f))
        throw UsageError(
            fmt::format("--material {}: expected a weight of 0 or more after the equals sign", text));
    return material;
}

} // namespace

void AppearanceArguments::add(CLI::App& command) {
    command
        .add_option("-m,--material", mMaterials,
                    "Show this material of the bake, wherever a part has it; those of one set are blended by "
                    "their weights (default 1) over the sum of these: -m clay=0.3 -m gold=0.7")
        ->type_name("NAME[=WEIGHT]")
        ->allow_extra_args(false); // one each, since FILE may follow
}

Appearance AppearanceArguments::appearance(const Asset& asset) const {
    Appearance appearance = defaultAppearance(asset);
    if (mMaterials.empty()) return appearance;
    const std::vector<std::string> names = materialNames(asset);
    std::vector<WeightedMaterial> blend;
    float sum = 0;
    for (const std::string& text : mMaterials) {
        blend.push_back(parse(text, names));
        sum += blend.back().weight;
        if (std::ranges::count(blend, blend.back().name, &WeightedMaterial::name) > 1)
            throw UsageError(fmt::format("--material: \"{}\" is named twice", blend.back().name));
    }
    if (sum == 0) throw UsageError("--material: expected at least one weight above 0");
    bindMaterials(appearance, asset, blend);
    return appearance;
}

} // namespace relume
