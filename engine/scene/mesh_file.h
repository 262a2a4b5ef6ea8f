// Mesh files: OBJ, PLY, glTF 2.0 (.gltf, .glb), told apart by extension.
#pragma once

#include "engine/scene/mesh.h"
#include "engine/scene/scene.h"

#include <filesystem>

namespace relume {

// Reads, triangulates, welds (equal position and, where given, normal), drops degenerate triangles
// (with a count in the log), makes angle-weighted normals where the file has none, and turns Z up
// into Y up on request. Throws Error for anything truncated, corrupt, absurd, empty or not finite.
Mesh readMesh(const std::filesystem::path& path, UpAxis up = UpAxis::Y);

} // namespace relume
