// Meshes for tests, and mesh files written by hand for tests of their readers.
#pragma once

#include "engine/scene/mesh.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fmt/core.h>
#include <string>

namespace relume::test {

// Makes a unit square in z = 0 that faces +z, its image upright: u right, v down.
inline Mesh makeSquare() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

enum class PlySample { Ascii, LittleEndian, BigEndian };

template <typename T>
void put(std::string& bytes, T value, bool isBigEndian = false) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (isBigEndian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

inline std::string document(const Mesh& mesh, const std::string& nodes, const std::string& uri) {
    const size_t vectors = 12 * mesh.vertexCount(), indices = 12 * mesh.triangleCount();
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}},"indices":2}}]}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
        R"({{"bufferView":1,"componentType":5126,"count":{},"type":"VEC3"}},)"
        R"({{"bufferView":2,"componentType":5125,"count":{},"type":"SCALAR"}}],)"
        R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},)"
        R"({{"buffer":0,"byteOffset":{},"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
        R"("buffers":[{{{}"byteLength":{}}}]}})",
        nodes, mesh.vertexCount(), mesh.vertexCount(), 3 * mesh.triangleCount(), vectors, vectors, vectors,
        2 * vectors, indices, uri.empty() ? "" : "\"uri\":\"" + uri + "\",", 2 * vectors + indices);
}

inline std::string sampleObj(const Mesh& mesh) {
    std::string text = "# a sample\no sample\n";
    for (const vec3& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const vec3& n : mesh.normals) text += fmt::format("vn {} {} {}\n", n.x, n.y, n.z);
    for (const uvec3& t : mesh.triangles)
        text += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", t.x + 1, t.y + 1, t.z + 1);
    return text;
}

inline std::string samplePly(const Mesh& mesh, PlySample format) {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    std::string bytes =
        fmt::format("ply\nformat {} 1.0\nelement vertex {}\n", names[int(format)], mesh.vertexCount());
    for (const char* property : {"x", "y", "z", "nx", "ny", "nz"})
        bytes += fmt::format("property float {}\n", property);
    bytes += fmt::format("element face {}\nproperty list uchar int vertex_index\nend_header\n",
                         mesh.triangleCount());
    const bool isBig = format == PlySample::BigEndian;
    for (size_t i = 0; i < mesh.vertexCount(); i++) {
        const vec3 p = mesh.positions[i], n = mesh.normals[i];
        if (format == PlySample::Ascii)
            bytes += fmt::format("{} {} {} {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z);
        else
            for (const float value : {p.x, p.y, p.z, n.x, n.y, n.z}) put(bytes, value, isBig);
    }
    for (const uvec3& t : mesh.triangles) {
        if (format == PlySample::Ascii) {
            bytes += fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
        } else {
            put(bytes, uint8_t(3));
            for (int i = 0; i < 3; i++) put(bytes, t[i], isBig);
        }
    }
    return bytes;
}

// Positions, normals and 32-bit indices, as the glTF samples refer to them.
inline std::string sampleBuffer(const Mesh& mesh) {
    std::string bytes;
    for (const std::vector<vec3>& vectors : {mesh.positions, mesh.normals})
        for (const vec3& v : vectors)
            for (int axis = 0; axis < 3; axis++) put(bytes, v[axis]);
    for (const uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; i++) put(bytes, t[i]);
    return bytes;
}

// A text document whose buffer is at `uri`; `nodes` lists its nodes, of which the first is the root.
inline std::string sampleGltf(const Mesh& mesh, const std::string& uri) {
    return document(mesh, R"({"mesh":0})", uri);
}

// A binary document of this JSON and buffer.
inline std::string glbOf(std::string json, const std::string& buffer) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    put(bytes, uint32_t(2));
    put(bytes, uint32_t(12 + 8 + json.size() + 8 + buffer.size()));
    put(bytes, uint32_t(json.size()));
    bytes += "JSON" + json;
    put(bytes, uint32_t(buffer.size()));
    bytes += std::string("BIN\0", 4) + buffer;
    return bytes;
}

// A binary document; the first `from` in its JSON is replaced by `to`.
inline std::string sampleGlb(const Mesh& mesh, const std::string& nodes = R"({"mesh":0})",
                             const std::string& from = "", const std::string& to = "") {
    std::string json = document(mesh, nodes, "");
    if (!from.empty()) json.replace(json.find(from), from.size(), to);
    return glbOf(json, sampleBuffer(mesh));
}

} // namespace relume::test
