// Measures which visibility method is faster on a device.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/visibility/visibility.h"

namespace relume {

// Times each method on 16 vertices of the asset and logs the choice. Needs the asset's occluder, meshes and
// sizes. The result may vary between runs.
VisibilityMethod fasterVisibility(const vk::Device& device, const Asset& asset);

} // namespace relume
