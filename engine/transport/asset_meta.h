// The META chunk of a .relume file: everything about an asset that is not an array.
#pragma once

#include "engine/transport/asset.h"

#include <span>
#include <vector>

namespace relume {

// Limits that keep a hostile META chunk from standing for much memory.
constexpr size_t kLargestMeta = size_t(1) << 20; // bytes

constexpr size_t kVisibilityKeyDigits = 32; // XXH3-128, in hexadecimal

// How long a part's arrays are.
struct AssetPartSizes {
    uint64_t vertices = 0, triangles = 0, uvs = 0, colors = 0, tangents = 0;
};

// How long an asset's arrays are. The sizes of maps, textures and kernels are set in the asset.
struct AssetSizes {
    uint64_t occluderVertices = 0, occluderTriangles = 0;
    std::vector<AssetPartSizes> parts;
    std::vector<uint64_t> setEntries; // one per set, over all parts: entries of its transport
};
AssetSizes sizesOf(const Asset& asset, std::span<const uint64_t> setEntries);

// An asset whose arrays are still empty, and how long they are.
struct AssetMeta {
    Asset asset;
    AssetSizes sizes;
    std::string visibilityKey; // of the kept visibility (visibility_chunk.h); empty: none is kept
};

// Throws Error when the bytes pass kLargestMeta.
std::vector<std::byte> encodeMeta(const Asset& asset, const AssetSizes& sizes,
                                  const std::string& visibilityKey = {});

// Throws Error for bytes that encodeMeta() does not make, or with numbers that do not fit their fields;
// whether they make sense together is for checkAsset to say. `name` stands for the file in errors.
AssetMeta decodeMeta(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
