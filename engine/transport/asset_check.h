// What must hold in every asset, whether it is about to be written or has just been read.
#pragma once

#include "engine/chunk/block_chunk.h"
#include "engine/transport/asset.h"

namespace relume {

constexpr int kSmallestFace = 8, kLargestFace = 64; // indices of 6 · 64² coefficients fit 16 bits
constexpr int kSmallestVisibility = 16, kLargestVisibility = 1024;
constexpr int kLargestLayers = 64; // of view maps in a set
constexpr int kMostBounces = 8;
constexpr int kSmallestMap = 4, kLargestMap = 256;

// Everything of an asset but its transport.
void checkSkeleton(const Asset& asset, const std::string& name);

// Sizes agree, indices lie within their arrays, numbers are finite and within their range, normals are unit
// vectors, rows rise. `name` stands for the asset in errors. Throws Error for the first thing that is wrong.
void checkAsset(const Asset& asset, const std::string& name);

} // namespace relume
