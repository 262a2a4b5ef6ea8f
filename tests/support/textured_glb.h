// A binary glTF file of two textured squares, for tests of its reader.
#pragma once

#include "engine/import/mesh_formats.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/texture_samples.h"

#include <fmt/core.h>

namespace relume::test {

// Decodes a binary glTF file, whose references are relative to `folder`.
inline GltfParts decodeGlb(const std::string& bytes, const std::filesystem::path& folder = {}) {
    return decodeGltfParts(std::as_bytes(std::span(bytes)), folder, "a.glb");
}

inline std::string encodeBase64(const std::string& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t j = i; j < i + 3; j++) group = group << 8 | (j < bytes.size() ? uint8_t(bytes[j]) : 0);
        for (size_t j = 0; j < 4; j++)
            text += i + j > bytes.size() ? '=' : kDigits[group >> (18 - 6 * j) & 63];
    }
    return text;
}

// Two unit squares of two triangles, in z = 0 and z = 1, with a seam along the diagonal. Each text is a
// member of the document that a test may replace; buffer views are positions, normals, uvs, indices, and two
// images.
struct TexturedGlb {
    static inline const Texture kRed{2, 1, {0xff0000ff, 0xff00ff80}, true};
    static inline const Texture kBlue{1, 2, {0xffff0000, 0x80ff4000}, true};

    std::string primitives =
        R"([{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0},
            {"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":4,"material":1}])";
    std::string materials =
        R"([{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"metallicFactor":0,
             "roughnessFactor":0.75,"baseColorTexture":{"index":0}}},
            {"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}])";
    std::string textures = R"([{"source":0},{"source":1}])";
    std::string images =
        R"([{"bufferView":4,"mimeType":"image/png"},{"bufferView":5,"mimeType":"image/png"}])";

    struct Content {
        std::string json, buffer;
    };

    Content content() const {
        std::string buffer, views;
        const auto addView = [&](const std::string& data) {
            views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})",
                                 views.empty() ? "" : ",", buffer.size(), data.size());
            buffer += data + std::string((4 - data.size() % 4) % 4, '\0');
        };
        for (const std::string& data : {positions(), normals(), uvs(), indices()}) addView(data);
        for (const Texture& texture : {kRed, kBlue}) addView(samplePng(texture));
        const std::string json = fmt::format(
            R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
            R"("meshes":[{{"primitives":{}}}],"materials":{},"textures":{},"images":{},"accessors":[)"
            R"({{"bufferView":0,"componentType":5126,"count":12,"type":"VEC3"}},)"
            R"({{"bufferView":1,"componentType":5126,"count":12,"type":"VEC3"}},)"
            R"({{"bufferView":2,"componentType":5126,"count":12,"type":"VEC2"}},)"
            R"({{"bufferView":3,"componentType":5125,"count":6,"type":"SCALAR"}},)"
            R"({{"bufferView":3,"byteOffset":24,"componentType":5125,"count":6,"type":"SCALAR"}}],)"
            R"("bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}})",
            primitives, materials, textures, images, views, buffer.size());
        return {json, buffer};
    }

    std::string bytes() const {
        const auto [json, buffer] = content();
        return glbOf(json, buffer);
    }

  private:
    static std::string positions() {
        std::string data;
        for (const float z : {0.0f, 1.0f})
            for (const vec2 p : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1)})
                for (const float value : {p.x, p.y, z}) put(data, value);
        return data;
    }
    static std::string normals() {
        std::string data;
        for (int i = 0; i < 12; i++)
            for (const float value : {0.0f, 0.0f, 1.0f}) put(data, value);
        return data;
    }
    // The second triangle of a square has its coordinates shifted: a seam.
    static std::string uvs() {
        std::string data;
        for (int square = 0; square < 2; square++)
            for (const vec2 p : {vec2(0, 0), vec2(0.5f, 0), vec2(0.5f, 0.5f), vec2(0.25f, 0),
                                 vec2(0.75f, 0.5f), vec2(0.25f, 0.5f)})
                for (const float value : {p.x, p.y}) put(data, value);
        return data;
    }
    static std::string indices() {
        std::string data;
        for (uint32_t i = 0; i < 12; i++) put(data, i);
        return data;
    }
};

} // namespace relume::test
