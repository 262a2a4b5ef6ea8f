// What can be shown of a scene at once, before anything is baked.
#pragma once

#include "engine/import/scene.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

namespace relume {

// Returns an asset of the scene without transport: what ViewOptions::isUnshadowed draws, exactly, after a
// tenth of a second for an ordinary mesh. Its meshes are not refined, and its vertices not in the order of
// the bake. Throws Error.
Asset makeSketch(const vk::Device& device, Scene scene);

} // namespace relume
