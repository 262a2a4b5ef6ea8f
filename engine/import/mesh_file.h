// Mesh files: OBJ, PLY, glTF 2.0 (.gltf, .glb), told apart by extension.
#pragma once

#include "engine/import/scene.h"
#include "engine/scene/mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace relume {

// Reads, triangulates, welds (equal position and, where given, normal), drops degenerate triangles
// (with a count in the log), makes angle-weighted normals where the file has none, and turns Z up
// into Y up on request. Uvs and colors are kept, and kept apart, where they are wanted. Throws Error for
// anything truncated, corrupt, absurd, empty or not finite.
Mesh readMesh(const std::filesystem::path& path, UpAxis up = UpAxis::Y, MeshAttributes wanted = {});

// The same from a file's bytes; `path` gives the format by its extension, the folder that a glTF file's
// buffers may lie in, and the name in errors.
Mesh decodeMesh(std::span<const std::byte> bytes, const std::filesystem::path& path, UpAxis up,
                MeshAttributes wanted = {});

// Whether a file of this name is glTF, which brings materials of its own.
bool isGltf(const std::filesystem::path& path);

// Turns a mesh that has Z up into one that has Y up.
void turnZUp(Mesh& mesh);

} // namespace relume
