#include "apps/viewer/screenshot.h"

#include <array>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

constexpr std::array kToneNames = {"none", "aces", "agx"};

// Returns the double with the shortest text that is read as this float.
double shortest(float value) { return std::stod(fmt::format("{}", value)); }

nlohmann::json shortestList(vec3 v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }

// Quotes text for a shell.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

} // namespace

Image screenImage(std::span<const uint8_t> pixels, int width, int height, VkFormat format) {
    Image image(width, height);
    const bool isBgra = format == VK_FORMAT_B8G8R8A8_UNORM;
    for (size_t i = 0; i < image.pixels.size(); i++) {
        const auto channel = [&](size_t c) { return float(pixels[4 * i + c]) / 255; };
        image.pixels[i] = {channel(isBgra ? 2 : 0), channel(1), channel(isBgra ? 0 : 2), 1};
    }
    return image;
}

bool needsLightFile(const LightState& light) {
    return !light.file &&
           (light.isDay() || !light.lamps.empty() || !light.strokes.empty() || light.environmentGain != 1);
}

nlohmann::ordered_json renderOptions(const SceneState& state, GroundStyle ground, Drawn drawn) {
    const LightState& light = state.light;
    const Camera camera = state.orbit->camera();
    nlohmann::ordered_json options{{"eye", shortestList(camera.eye)},
                                   {"target", shortestList(camera.target)},
                                   {"fov", shortest(state.fovDegrees)},
                                   {"rotate", shortest(light.rotation)}};
    if (light.selection.threshold)
        options["threshold"] = *light.selection.threshold;
    else
        options["coefficients"] = light.selection.count;
    if (light.file) {
        options["light"] = light.fileName.string();
        options["time"] = light.seconds;
    } else if (!needsLightFile(light) && !light.chosen().file.empty())
        options["environment"] = light.chosen().file.string();
    for (const WeightedMaterial& material : state.material) {
        // A name with an equals sign would be read as a name and a weight.
        const bool isPlain = state.material.size() == 1 && material.name.find('=') == std::string::npos;
        options["material"].push_back(isPlain ? material.name
                                              : fmt::format("{}={}", material.name, material.weight));
    }
    if (state.samples != kDefaultSamples) options["samples"] = state.samples;
    if (state.terms > 0) options["terms"] = state.terms;
    if (!state.addsResidual) options["residual"] = "off";
    const auto withGround = [&](GroundStyle byDefault) {
        if (ground != byDefault) options["ground-style"] = kGroundStyleNames[size_t(ground)];
        return options;
    };
    if (drawn == Drawn::Radiance) return withGround(GroundStyle::Whole);
    const bool isSeen = state.background == BackgroundKind::Environment; // default of .png
    options["exposure"] = shortest(state.exposure);
    options["tone"] = kToneNames[size_t(state.tone)];
    if (!isSeen) options["background"] = "none";
    if (isSeen && state.backgroundBlur > 0) options["background-blur"] = shortest(state.backgroundBlur);
    return withGround(isSeen ? GroundStyle::Shadow : GroundStyle::Whole);
}

std::string renderCommand(const nlohmann::ordered_json& options, const std::filesystem::path& bake, int width,
                          int height, Drawn drawn) {
    std::string command = fmt::format("relume render {} -o image.{} --size {}x{}", quoted(bake.string()),
                                      drawn == Drawn::Picture ? "png" : "exr", width, height);
    // Numbers follow a "=", since they may begin with a minus sign.
    const auto textOf = [](const nlohmann::json& value) {
        return value.is_string() ? ' ' + quoted(value.get<std::string>())
                                 : fmt::format("={}", value.get<double>());
    };
    for (const auto& [name, value] : options.items()) {
        if (!value.is_array()) {
            command += " --" + name + textOf(value);
        } else if (value[0].is_string()) {
            for (const auto& each : value) command += " --" + name + textOf(each);
        } else {
            command += fmt::format(" --{}={},{},{}", name, value[0].get<double>(), value[1].get<double>(),
                                   value[2].get<double>());
        }
    }
    return command;
}

} // namespace relume
