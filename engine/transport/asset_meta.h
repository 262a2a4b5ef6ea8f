// The META chunk of a .relume file: everything about an asset that is not an array, as JSON.
#pragma once

#include "engine/transport/asset.h"

#include <span>
#include <string_view>

namespace relume {

// Limits that keep a hostile META chunk from standing for much memory.
constexpr size_t kLargestMeta = size_t(1) << 20; // bytes
constexpr size_t kLargestMetaDepth = 8;          // nested arrays and objects

constexpr size_t kVisibilityKeyDigits = 32; // XXH3-128, in hexadecimal

// How long a part's arrays are.
struct AssetPartSizes {
    uint64_t vertices = 0, triangles = 0, uvs = 0, colors = 0, tangents = 0;
};

// An asset whose arrays are still empty, and how long they are. The sizes of maps, textures and transport are
// set in the asset.
struct AssetMeta {
    Asset asset;
    uint64_t occluderVertices = 0, occluderTriangles = 0;
    std::vector<AssetPartSizes> sizes; // one per part
    std::vector<uint64_t> setEntries;  // one per set, over all parts: entries of its transport
    std::string visibilityKey;         // of the kept visibility; empty: none is kept
};

// `setEntries`: one per set, over all parts: entries of its transport. `visibilityKey`: of visibility that is
// kept (visibility_chunk.h); empty for none. Bytes that are not UTF-8 become
// U+FFFD. Throws Error when the text passes kLargestMeta.
std::string encodeMeta(const Asset& asset, std::span<const uint64_t> setEntries,
                       const std::string& visibilityKey = {});

// Throws Error for anything that is not such JSON, or with numbers that do not fit their fields; whether
// they make sense together is for checkAsset to say. `name` stands for the file in errors.
AssetMeta decodeMeta(std::string_view text, const std::string& name);

} // namespace relume
