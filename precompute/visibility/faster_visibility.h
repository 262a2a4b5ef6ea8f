// Which implementation of visibility is the faster on a device, measured.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/visibility/visibility.h"

namespace relume {

// Finds the visibility of some vertices of the asset, spread over its parts, in each way, and says on stderr
// what it chose. Needs the asset's occluder, meshes and sizes. The answer may differ from one run to another.
VisibilityMethod fasterVisibility(const vk::Device& device, const Asset& asset);

} // namespace relume
