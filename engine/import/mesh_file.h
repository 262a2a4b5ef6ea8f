// Reading of mesh files: OBJ, PLY, glTF 2.0 (.gltf, .glb), told apart by extension.
#pragma once

#include "engine/import/scene.h"
#include "engine/scene/mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace relume {

// Reads a mesh, triangulates it, cleans it up (mesh_cleanup.h), and turns Z up into Y up on request. Keeps
// the attributes in `wanted`. Throws Error if the file is truncated, corrupt, absurd, empty or not finite.
Mesh readMesh(const std::filesystem::path& path, UpAxis up = UpAxis::Y, MeshAttributes wanted = {});

// Reads a mesh from a file's bytes. `path` gives the format by its extension, the folder that a glTF file's
// buffers may be in, and the name in errors.
Mesh decodeMesh(std::span<const std::byte> bytes, const std::filesystem::path& path, UpAxis up,
                MeshAttributes wanted = {});

// Returns whether a file of this name is glTF, which has materials of its own.
bool isGltf(const std::filesystem::path& path);

// Turns a mesh with Z up into one with Y up.
void turnZUp(Mesh& mesh);

} // namespace relume
