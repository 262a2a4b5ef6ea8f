// The readers behind mesh_file.h, one per format. They decode a file's bytes; cleanUp() checks the mesh. They
// throw Error, in which `name` names the file, if the bytes cannot be decoded, and return those wanted uvs
// and colors that the file has.
#pragma once

#include "engine/import/scene.h"
#include "engine/scene/mesh.h"
#include "engine/scene/surface_detail.h"
#include "engine/scene/texture.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace relume {

// Decodes Wavefront OBJ: faces of any number of corners, all objects and groups as one mesh.
Mesh decodeObj(std::span<const std::byte> bytes, const std::string& name, MeshAttributes wanted);

// Decodes PLY 1.0, ASCII and binary of either byte order: element "vertex" with x, y, z and perhaps nx, ny,
// nz, texture coordinates (s, t; u, v; texture_u, texture_v) and red, green, blue, alpha; element "face" with
// the list "vertex_indices" or "vertex_index". Everything else is skipped.
Mesh decodePly(std::span<const std::byte> bytes, const std::string& name, MeshAttributes wanted);

// Decodes glTF 2.0, text or binary: the triangles of the default scene (or the first), with node transforms
// applied; skins and morph targets stay at rest. External buffers and images must be in or below `folder`.
Mesh decodeGltf(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                const std::string& name, MeshAttributes wanted);

// The triangles of a glTF file that share a material.
struct GltfPart {
    std::string name; // the material's, or "material N"; no two are equal
    Mesh mesh;        // with uvs if there is a texture, with colors if the file has any
    // {"model": "gltf", "base_color": [r, g, b], "metallic", "roughness"}, linear, in [0, 1]; or a set of
    // such materials that materialMap blends.
    std::string material;
    std::optional<Texture> baseColor;   // sRGB, multiplies base_color, as mesh.colors do
    std::optional<Texture> materialMap; // weights of the set
    SurfaceDetail detail;
};

struct GltfParts {
    std::vector<GltfPart> parts;   // by the material's number
    std::vector<InputFile> images; // files that were read
};

// Decodes glTF as parts of one material each, cleaned up, with the holes of masked materials cut out.
// Unsupported features are ignored, and logged.
GltfParts decodeGltfParts(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                          const std::string& name);

} // namespace relume
