// The readers behind mesh_file.h, one per format: they decode, cleanUp() judges. Each takes a whole file's
// bytes and throws Error, in which `name` stands for the file, when they cannot be decoded; of uvs and colors
// it gives those that are wanted and that the file has.
#pragma once

#include "engine/scene/mesh.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace relume {

// Wavefront OBJ: faces of any number of corners, all objects and groups as one mesh.
Mesh decodeObj(std::span<const std::byte> bytes, const std::string& name, MeshAttributes wanted);

// PLY 1.0, ASCII and binary of either byte order: element "vertex" with x, y, z and perhaps nx, ny, nz,
// texture coordinates (s, t; u, v; texture_u, texture_v) and red, green, blue, alpha; element "face" with the
// list "vertex_indices" or "vertex_index". Everything else is skipped.
Mesh decodePly(std::span<const std::byte> bytes, const std::string& name, MeshAttributes wanted);

// glTF 2.0, text or binary: the triangles of the default scene (or the first), node transforms applied;
// skins and morph targets stay at rest. External buffers are read from `folder` and below only.
Mesh decodeGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& name, MeshAttributes wanted);

} // namespace relume
