// A small asset whose file keeps visibility.
#pragma once

#include "engine/transport/asset_arrays.h"
#include "engine/transport/asset_meta.h"
#include "engine/transport/visibility_chunk.h"
#include "tests/support/asset_sample.h"

namespace relume::test {

constexpr const char* kVisibilityKey = "0123456789abcdef0123456789abcdef";

// Of visibility in the least size that can be kept.
inline Asset keptAsset(const SampleSize& size = {}) {
    Asset asset = sampleAsset(1, size);
    asset.visibilitySize = 64;
    return asset;
}

constexpr size_t kKeptVertexWords = 6 * 64 * 64 / 32;

inline std::vector<uint32_t> bitsOf(uint32_t part, size_t vertices) {
    std::mt19937 random(part);
    std::vector<uint32_t> bits(vertices * kKeptVertexWords);
    for (uint32_t& word : bits) word = random() % 8 == 0 ? random() : 0;
    return bits;
}

// Writes a key, of whatever form, into META, the first chunk.
inline void setVisibilityKey(std::vector<RawChunk>& chunks, const std::string& key) {
    std::vector<std::byte>& raw = chunks[0].raw;
    const AssetMeta meta = decodeMeta(raw, "sample");
    raw = encodeMeta(meta.asset, meta.sizes, key);
}

// The chunks of keptAsset() with its visibility.
inline std::vector<RawChunk> keptChunks(const SampleSize& size = {}) {
    const Asset asset = keptAsset(size);
    std::vector<RawChunk> chunks = chunksOf(encodeAsset(asset));
    setVisibilityKey(chunks, kVisibilityKey);
    const uint32_t block = visibilityRunVertices(asset);
    for (uint32_t part = 0; part < asset.parts.size(); part++) {
        const size_t vertices = asset.parts[part].mesh.vertexCount();
        const std::vector<uint32_t> bits = bitsOf(part, vertices);
        for (uint32_t run = 0; run * block < vertices; run++) {
            const size_t first = run * block, count = std::min<size_t>(block, vertices - first);
            const auto own = std::span(bits).subspan(first * kKeptVertexWords, count * kKeptVertexWords);
            chunks.push_back({kVisibility, part, run, encodeVisibility(own, 64)});
        }
    }
    return chunks;
}

} // namespace relume::test
