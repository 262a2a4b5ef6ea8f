// What decides visibility bits, as a hash: bits of equal keys are equal.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/visibility/visibility.h"

namespace relume {

// XXH3-128, as 32 hexadecimal digits, of the method and its kernels' SPIR-V, device and driver, the cube's
// size, how vertices are lifted, the occluder, and every part's positions and normals.
std::string visibilityKey(const Asset& asset, VisibilityMethod method);

} // namespace relume
