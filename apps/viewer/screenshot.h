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

// The command line that draws the same view of `bake`, bit for bit. `state` has its orbit; `light` is where
// lightFileOf() was written, if it was needed.
std::string renderCommand(const SceneState& state, const std::filesystem::path& bake, int width, int height,
                          const std::filesystem::path& light);

} // namespace relume
