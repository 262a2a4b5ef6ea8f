// A hash of everything that determines visibility bits: equal keys mean equal bits.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/visibility/visibility.h"

namespace relume {

// Returns the XXH3-128, as 32 hexadecimal digits, of the method and its kernels' SPIR-V, device and driver,
// the cube's size, the visibility offset, the occluder, and every part's positions and normals.
std::string visibilityKey(const Asset& asset, VisibilityMethod method);

} // namespace relume
