#include "engine/import/gltf_extensions.h"

#include "engine/import/gltf_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>

namespace relume {
namespace {

// A factor of an extension as a parameter of the model.
struct Factor {
    const char *extension, *key, *parameter;
    size_t count; // of numbers
    double least, most;
};

constexpr double kMostFactor = 1000, kMostRadians = 1e6;

constexpr Factor kFactors[] = {
    {"KHR_materials_ior", "ior", "ior", 1, 0, kMostFactor},
    {"KHR_materials_specular", "specularFactor", "specular", 1, 0, 1},
    {"KHR_materials_specular", "specularColorFactor", "specular_color", 3, 0, kMostFactor},
    {"KHR_materials_anisotropy", "anisotropyStrength", "anisotropy", 1, 0, 1},
    {"KHR_materials_anisotropy", "anisotropyRotation", "anisotropy_rotation", 1, -kMostRadians, kMostRadians},
    {"KHR_materials_sheen", "sheenColorFactor", "sheen_color", 3, 0, 1},
    {"KHR_materials_sheen", "sheenRoughnessFactor", "sheen_roughness", 1, 0, 1},
    {"KHR_materials_clearcoat", "clearcoatFactor", "clearcoat", 1, 0, 1},
    {"KHR_materials_clearcoat", "clearcoatRoughnessFactor", "clearcoat_roughness", 1, 0, 1},
};

// The reader of emission knows this one.
constexpr std::string_view kEmissiveStrength = "KHR_materials_emissive_strength";

bool isKnown(std::string_view extension) {
    return extension == kEmissiveStrength ||
           std::ranges::any_of(kFactors, [&](const Factor& factor) { return factor.extension == extension; });
}

} // namespace

nlohmann::ordered_json readGltfExtensions(const nlohmann::json& material, const std::string& place,
                                          const std::function<void(const std::string&)>& ignore) {
    const nlohmann::json& extensions = gltfObject(material, "extensions", place);
    for (const auto& [extension, members] : extensions.items()) {
        if (!isKnown(extension)) ignore(extension.substr(0, 60));
        if (!isKnown(extension) || !members.is_object()) continue;
        for (const auto& [key, value] : members.items())
            if (key.ends_with("Texture")) ignore(key.substr(0, 60));
    }
    nlohmann::ordered_json parameters = nlohmann::ordered_json::object();
    for (const Factor& factor : kFactors) {
        const nlohmann::json& extension = gltfObject(extensions, factor.extension, place);
        if (!findGltfMember(extension, factor.key, place)) continue;
        std::vector<double> values(factor.count, 0);
        if (factor.count == 1)
            values[0] = gltfNumber(extension, factor.key, 0, place);
        else
            values = gltfNumbers(extension, factor.key, values, place);
        for (double& value : values) value = std::clamp(value, factor.least, factor.most);
        if (factor.key == std::string_view("anisotropyRotation"))
            values[0] = std::remainder(values[0] * 180 / std::numbers::pi, 360);
        if (factor.count == 1)
            parameters[factor.parameter] = values[0];
        else
            parameters[factor.parameter] = values;
    }
    return parameters;
}

} // namespace relume
