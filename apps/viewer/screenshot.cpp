#include "apps/viewer/screenshot.h"

#include <fmt/format.h>

namespace relume {

namespace {

// For a shell.
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

std::string renderCommand(const SceneState& state, bool fadesGround, const std::filesystem::path& bake,
                          int width, int height, const std::filesystem::path& lightFile, Drawn drawn) {
    const LightState& light = state.light;
    const Camera camera = state.orbit->camera();
    std::string command = fmt::format(
        "relume render {} -o image.{} --size {}x{} --eye={},{},{} --target={},{},{} --fov {} --rotate={}",
        quoted(bake.string()), drawn == Drawn::Picture ? "png" : "exr", width, height, camera.eye.x,
        camera.eye.y, camera.eye.z, camera.target.x, camera.target.y, camera.target.z, state.fovDegrees,
        light.rotation);
    if (!light.selection.threshold)
        command += fmt::format(" --coefficients {}", light.selection.count);
    else
        command += fmt::format(" --threshold {}", *light.selection.threshold);
    if (light.file)
        command += fmt::format(" --light {} --time {}", quoted(light.fileName.string()), light.seconds);
    else if (needsLightFile(light))
        command += fmt::format(" --light {}", quoted(lightFile.string()));
    else if (!light.chosen().file.empty())
        command += fmt::format(" -e {}", quoted(light.chosen().file.string()));
    for (const WeightedMaterial& worn : state.material)
        command += state.material.size() == 1
                       ? fmt::format(" -m {}", quoted(worn.name))
                       : fmt::format(" -m {}", quoted(fmt::format("{}={}", worn.name, worn.weight)));
    if (state.samples != kDefaultSamples) command += fmt::format(" --samples {}", state.samples);
    if (state.terms > 0) command += fmt::format(" --terms {}", state.terms);
    if (!state.addsResidual) command += " --residual off";
    const bool isSeen = state.background == Behind::Environment; // what .png has if nothing is said
    if (drawn == Drawn::Radiance) return command + (fadesGround ? " --ground-fade" : "");
    constexpr const char* kCurves[] = {"none", "aces", "agx"};
    command += fmt::format(" --exposure={} --tone {}", state.exposure, kCurves[size_t(state.tone)]);
    if (!isSeen) command += " --background none";
    if (isSeen && state.backgroundBlur > 0)
        command += fmt::format(" --background-blur {}", state.backgroundBlur);
    if (isSeen && !fadesGround) command += " --no-ground-fade";
    return command;
}

} // namespace relume
