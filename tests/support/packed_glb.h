// A glTF file whose geometry EXT_meshopt_compression packs, for tests of its reader.
#pragma once

#include "tests/support/textured_glb.h"

#include <array>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>
#include <vector>

namespace relume::test {

// The squares of TexturedGlb: positions by the exponential filter, normals of (.6, 0, .8) by the octahedral
// one, texture coordinates without, tangents of (.6, .8, 0) by that of quaternions, and triangles or plain
// indices.
struct PackedGlb {
    nlohmann::json json;
    std::string buffer;

    explicit PackedGlb(const std::string& indexMode = "TRIANGLES") {
        const auto content = TexturedGlb().content();
        json = nlohmann::json::parse(content.json);
        buffer = content.buffer;
        const size_t packed = buffer.size();
        std::vector<float> positions = floats(0, 36), uvs = floats(2, 24);
        std::vector<float> normals, turns;
        for (size_t i = 0; i < kVertices; i++) {
            normals.insert(normals.end(), {0.6f, 0, 0.8f, 0});
            turns.insert(turns.end(), {0.6f, 0.8f, 0, 0});
        }
        std::vector<uint32_t> exponents(positions.size());
        meshopt_encodeFilterExp(exponents.data(), kVertices, 12, 15, positions.data());
        pack(0, "EXPONENTIAL", 12, exponents.data());
        std::array<uint32_t, kVertices> octahedral;
        meshopt_encodeFilterOct(octahedral.data(), kVertices, 4, 8, normals.data());
        pack(1, "OCTAHEDRAL", 4, octahedral.data());
        pack(2, "NONE", 8, uvs.data());
        std::array<uint64_t, kVertices> quaternions;
        meshopt_encodeFilterQuat(quaternions.data(), kVertices, 8, 16, turns.data());
        json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 8 * kVertices}, {"byteStride", 8}});
        pack(6, "QUATERNION", 8, quaternions.data());
        packIndices(indexMode);

        json["accessors"][1] = accessor(1, 5120, "VEC3");
        json["accessors"].push_back(accessor(6, 5122, "VEC4"));
        json["bufferViews"][1]["byteStride"] = 4;
        json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = 5;
        json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
        json["buffers"].push_back(
            {{"byteLength", packed}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
        json["buffers"][0]["byteLength"] = buffer.size();
    }

    std::string bytes() const { return glbOf(json.dump(), buffer); }

    // Returns the extension's description of a view.
    nlohmann::json& description(size_t view) {
        return json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
    }

  private:
    static constexpr size_t kVertices = 12;

    static nlohmann::json accessor(int view, int component, const char* type) {
        return {{"bufferView", view},
                {"componentType", component},
                {"normalized", true},
                {"count", kVertices},
                {"type", type}};
    }

    // Returns the numbers in a view of the plain file.
    std::vector<float> floats(size_t view, size_t count) const {
        std::vector<float> values(count);
        std::memcpy(values.data(), buffer.data() + json["bufferViews"][view]["byteOffset"].get<size_t>(),
                    4 * count);
        return values;
    }

    void pack(size_t view, const char* filter, size_t stride, const void* vertices) {
        std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(kVertices, stride));
        bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), vertices, kVertices, stride));
        add(view, "ATTRIBUTES", filter, stride, bytes);
    }

    void packIndices(const std::string& mode) {
        std::vector<uint32_t> indices(kVertices);
        std::memcpy(indices.data(), buffer.data() + json["bufferViews"][3]["byteOffset"].get<size_t>(),
                    4 * kVertices);
        std::vector<unsigned char> bytes(256);
        bytes.resize(
            mode == "TRIANGLES"
                ? meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), kVertices)
                : meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), kVertices));
        add(3, mode, "NONE", 4, bytes);
    }

    void add(size_t view, const std::string& mode, const char* filter, size_t stride,
             const std::vector<unsigned char>& bytes) {
        description(view) = {{"buffer", 0},
                             {"byteOffset", buffer.size()},
                             {"byteLength", bytes.size()},
                             {"byteStride", stride},
                             {"mode", mode},
                             {"count", kVertices},
                             {"filter", filter}};
        json["bufferViews"][view]["buffer"] = 1;
        buffer.append(bytes.begin(), bytes.end());
        buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    }
};

} // namespace relume::test
