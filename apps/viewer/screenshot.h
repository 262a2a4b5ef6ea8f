// What a window shows, as files keep it.
#pragma once

#include "apps/viewer/scene_state.h"
#include "engine/image/image.h"

#include <span>
#include <vulkan/vulkan.h>

namespace relume {

// The display values of pixels as a swapchain of this format has them: four bytes each.
Image screenImage(std::span<const uint8_t> pixels, int width, int height, VkFormat format);

// Whether lightFileOf() must be written for a command to say what lights the object.
bool needsLightFile(const LightState& light);

// What is drawn: linear radiance without a background, or a picture as it is seen without panels.
enum class Drawn { Radiance, Picture };

// Returns the options of `relume render`, by name, that draw the same view bit for bit; without a light that
// needsLightFile(). `state` has its orbit; `fadesGround`: SceneView::fadesGround().
nlohmann::ordered_json renderOptions(const SceneState& state, bool fadesGround, Drawn drawn);

// Returns the command line with these options.
std::string renderCommand(const nlohmann::ordered_json& options, const std::filesystem::path& bake, int width,
                          int height, Drawn drawn);

} // namespace relume
