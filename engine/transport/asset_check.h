// Checks of what must hold in every asset, whether it is about to be written or was just read.
#pragma once

#include "engine/chunk/block_chunk.h"
#include "engine/transport/asset.h"

namespace relume {

constexpr int kSmallestFace = 8, kLargestFace = 64; // indices of 6 · 64² coefficients fit 16 bits
constexpr int kSmallestVisibility = 16, kLargestVisibility = 1024;
constexpr int kLargestLayers = 64; // of view maps in a set
constexpr int kMostBounces = 8;
constexpr int kSmallestMap = 4, kLargestMap = 256;

// Checks everything in an asset except its transport. Throws Error.
void checkSkeleton(const Asset& asset, const std::string& name);

// Checks that sizes agree, indices lie within their arrays, numbers are finite and in range, normals are unit
// vectors, and indices rise within rows. Throws Error for the first fault; `name` names the asset in it.
void checkAsset(const Asset& asset, const std::string& name);

} // namespace relume
