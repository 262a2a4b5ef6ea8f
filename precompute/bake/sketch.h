// Makes an asset that can be shown at once, before anything is baked.
#pragma once

#include "engine/import/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

namespace relume {

// Returns an asset of the scene without transport, which ViewOptions::isUnshadowed can draw exactly; takes a
// tenth of a second for an ordinary mesh. Meshes are not refined, and vertices are not in bake order. Throws
// Error.
Asset makeSketch(const vk::Device& device, Scene scene);

} // namespace relume
