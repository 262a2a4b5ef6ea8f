#include "engine/import/mesh_file.h"

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/mesh_formats.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {
namespace {

std::string lowerExtension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return extension;
}

Mesh decodeAny(std::span<const std::byte> bytes, const std::filesystem::path& path, MeshAttributes wanted) {
    const std::string extension = lowerExtension(path), name = path.string();
    if (extension == ".obj") return decodeObj(bytes, name, wanted);
    if (extension == ".ply") return decodePly(bytes, name, wanted);
    if (isGltf(path)) return decodeGltf(bytes, path.parent_path(), name, wanted);
    throw Error(fmt::format("{}: expected a mesh ending in .obj, .ply, .gltf or .glb, found \"{}\"", name,
                            extension));
}

} // namespace

bool isGltf(const std::filesystem::path& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".gltf" || extension == ".glb";
}

void turnZUp(Mesh& mesh) {
    for (vec3& p : mesh.positions) p = {p.x, p.z, -p.y};
    for (vec3& n : mesh.normals) n = {n.x, n.z, -n.y};
    for (vec3& t : mesh.tangents) t = {t.x, t.z, -t.y};
}

Mesh decodeMesh(std::span<const std::byte> bytes, const std::filesystem::path& path, UpAxis up,
                MeshAttributes wanted) {
    Mesh mesh = cleanUp(decodeAny(bytes, path, wanted), path.string());
    if (up == UpAxis::Z) turnZUp(mesh);
    return mesh;
}

Mesh readMesh(const std::filesystem::path& path, UpAxis up, MeshAttributes wanted) {
    return decodeMesh(readFile(path), path, up, wanted);
}

} // namespace relume
