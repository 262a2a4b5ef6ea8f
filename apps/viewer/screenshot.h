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

// The command line that draws the same view of `bake` as linear radiance without a background, bit for bit;
// or as a picture, as it is seen without panels. `state` has its orbit; `fadesGround`:
// SceneView::fadesGround(); `light` is where lightFileOf() was written, if it was needed.
enum class Drawn { Radiance, Picture };
std::string renderCommand(const SceneState& state, bool fadesGround, const std::filesystem::path& bake,
                          int width, int height, const std::filesystem::path& light, Drawn drawn);

} // namespace relume
