// What a window shows, as files keep it.
#pragma once

#include "apps/viewer/scene_state.h"
#include "engine/image/image.h"

#include <span>
#include <vulkan/vulkan.h>

namespace relume {

// The display values of pixels as a swapchain of this format has them: four bytes each.
Image screenImage(std::span<const uint8_t> pixels, int width, int height, VkFormat format);

// The command line that draws the same view of `bake`, bit for bit; none where only a light file could say
// what lights it. `state` has its orbit.
std::optional<std::string> renderCommand(const SceneState& state, const std::filesystem::path& bake,
                                         int width, int height);

} // namespace relume
