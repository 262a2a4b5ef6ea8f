// The META chunk of a .relume file: everything about an asset that is not an array.
#pragma once

#include "engine/transport/asset.h"

#include <span>
#include <vector>

namespace relume {

// A limit that keeps a hostile META chunk from taking much memory.
constexpr size_t kLargestMeta = size_t(1) << 20; // bytes

// Limits of what META may say: vertices or triangles of a mesh, and entries of a set's transport.
constexpr uint64_t kMostMetaCount = 0xffffffff, kMostMetaEntries = uint64_t(1) << 48;

constexpr size_t kVisibilityKeyDigits = 32; // XXH3-128, in hexadecimal

// The lengths of a part's arrays.
struct AssetPartSizes {
    uint64_t vertices = 0, triangles = 0, uvs = 0, colors = 0, tangents = 0;
};

// The lengths of an asset's arrays. The sizes of maps, textures and kernels are in the asset.
struct AssetSizes {
    uint64_t occluderVertices = 0, occluderTriangles = 0;
    std::vector<AssetPartSizes> parts;
    std::vector<uint64_t> setEntries; // one per set, over all parts: entries of its transport
};
AssetSizes sizesOf(const Asset& asset, std::span<const uint64_t> setEntries);

// An asset whose arrays are still empty, and their lengths.
struct AssetMeta {
    Asset asset;
    AssetSizes sizes;
    std::string visibilityKey; // of the kept visibility (visibility_chunk.h); empty if none is kept
};

// Returns the bytes of chunk META. Throws Error if there would be more than kLargestMeta.
std::vector<std::byte> encodeMeta(const Asset& asset, const AssetSizes& sizes,
                                  const std::string& visibilityKey = {});

// Reads what encodeMeta() wrote. Throws Error for other bytes and for numbers that do not fit their fields;
// whether they are consistent is for checkAsset() to say. `name` names the file in errors.
AssetMeta decodeMeta(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
