#include "apps/viewer/screenshot.h"

#include <fmt/format.h>

namespace relume {

Image screenImage(std::span<const uint8_t> pixels, int width, int height, VkFormat format) {
    Image image(width, height);
    const bool isBgra = format == VK_FORMAT_B8G8R8A8_UNORM;
    for (size_t i = 0; i < image.pixels.size(); i++) {
        const auto channel = [&](size_t c) { return float(pixels[4 * i + c]) / 255; };
        image.pixels[i] = {channel(isBgra ? 2 : 0), channel(1), channel(isBgra ? 0 : 2), 1};
    }
    return image;
}

std::optional<std::string> renderCommand(const SceneState& state, const std::filesystem::path& bake,
                                         int width, int height) {
    const LightState& light = state.light;
    if (!light.file && (!light.lamps.empty() || light.environmentGain != 1)) return std::nullopt;
    const Camera camera = state.orbit->camera();
    std::string command = fmt::format(
        "relume render '{}' -o image.exr --size {}x{} --eye={},{},{} --target={},{},{} --fov {} --rotate={} "
        "--threshold {}",
        bake.string(), width, height, camera.eye.x, camera.eye.y, camera.eye.z, camera.target.x,
        camera.target.y, camera.target.z, state.fovDegrees, light.rotation, light.selection.threshold);
    if (light.file)
        command += fmt::format(" --light '{}' --time {}", light.fileName.string(), light.seconds);
    else if (const EnvironmentChoice& choice = light.environments[light.environment]; !choice.file.empty())
        command += fmt::format(" -e '{}'", choice.file.string());
    if (!state.material.empty()) command += fmt::format(" -m '{}'", state.material);
    return command;
}

} // namespace relume
