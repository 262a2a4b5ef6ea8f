#include "apps/relume/appearance_arguments.h"

#include "engine/base/error.h"

#include <charconv>
#include <cmath>

namespace relume {

namespace {

// NAME, or NAME=WEIGHT.
WeightedMaterial parse(const std::string& text) {
    const size_t equals = text.rfind('=');
    if (equals == std::string::npos) return {text};
    WeightedMaterial material{text.substr(0, equals)};
    const char* end = text.data() + text.size();
    const auto [rest, failure] = std::from_chars(text.data() + equals + 1, end, material.weight);
    if (failure != std::errc() || rest != end || !(material.weight >= 0 && material.weight <= 1))
        throw UsageError("--material {}: expected a weight from 0 to 1 after the equals sign", text);
    return material;
}

} // namespace

void AppearanceArguments::add(CLI::App& command) {
    command
        .add_option("-m,--material", mMaterials,
                    "Wear this material of the bake, wherever a part has it; several with weights are "
                    "blended, if they are of one set: -m clay=0.3 -m gold=0.7")
        ->type_name("NAME[=WEIGHT]")
        ->take_all();
}

Appearance AppearanceArguments::appearance(const Asset& asset) const {
    Appearance appearance = defaultAppearance(asset);
    std::vector<WeightedMaterial> blend;
    for (const std::string& material : mMaterials) blend.push_back(parse(material));
    if (!blend.empty()) wear(appearance, asset, blend);
    return appearance;
}

} // namespace relume
