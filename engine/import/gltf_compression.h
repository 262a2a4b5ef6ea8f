// Buffer views that EXT_meshopt_compression packs.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tiny_gltf.h>

namespace relume {

// The packed buffer views of a document, as it describes them, unchecked.
struct GltfPacking {
    std::map<size_t, nlohmann::json> views; // by number
    std::set<size_t> placeholders;          // numbers of buffers without bytes, for what views unpack to
};

// Finds the packed views, and the buffers that need no bytes since only views are unpacked to them.
GltfPacking readGltfPacking(const nlohmann::json& document);

// Unpacks each view into a buffer of its own. Throws Error, in which `name` stands for the file.
void unpackGltfViews(const GltfPacking& packing, tinygltf::Model& model, const std::string& name);

} // namespace relume
