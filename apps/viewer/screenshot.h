// Converts what the window shows to images and command lines.
#pragma once

#include "apps/viewer/scene_state.h"
#include "engine/image/image.h"

#include <span>
#include <vulkan/vulkan.h>

namespace relume {

// Returns the display values of pixels from a swapchain of this format, four bytes each.
Image screenImage(std::span<const uint8_t> pixels, int width, int height, VkFormat format);

// Returns whether a command line can only express this light by a light file (lightFileOf()).
bool needsLightFile(const LightState& light);

// The kind of image: linear radiance without background, or a picture like the window without panels.
enum class Drawn { Radiance, Picture };

// Returns the options of `relume render`, by name, that draw the same view bit for bit, without a light that
// needsLightFile(). `state` must have an orbit; `ground` is from SceneView::groundStyle().
nlohmann::ordered_json renderOptions(const SceneState& state, GroundStyle ground, Drawn drawn);

// Returns the command line with these options.
std::string renderCommand(const nlohmann::ordered_json& options, const std::filesystem::path& bake, int width,
                          int height, Drawn drawn);

} // namespace relume
