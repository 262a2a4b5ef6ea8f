// glTF files taken apart: the container, what the library makes of the geometry, and the rest as JSON.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace relume {

struct GltfDocument {
    tinygltf::Model model; // geometry and buffers only
    nlohmann::json looks;  // perhaps "materials", "textures", "images", "samplers", as the file has them
};

// Throws Error, in which `name` stands for the file. External buffers are read from `folder` and below only.
GltfDocument readGltfDocument(std::span<const std::byte> bytes, const std::filesystem::path& folder,
                              const std::string& name);

// Where the file is that a document in `folder` refers to by a relative address. Throws Error unless it is a
// file in `folder` or below.
std::filesystem::path findGltfFile(const std::string& uri, const std::filesystem::path& folder,
                                   const std::string& name);

} // namespace relume
