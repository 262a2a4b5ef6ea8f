// Buffer views that EXT_meshopt_compression packs.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tiny_gltf.h>

namespace relume {

// What a document says of its packed buffer views; nothing of it has been checked.
struct GltfPacking {
    std::map<size_t, nlohmann::json> views; // by number
    std::set<size_t> placeholders;          // numbers of buffers without bytes, for what views unpack to
};

GltfPacking readGltfPacking(const nlohmann::json& document);

// Unpacks each view into a buffer of its own. Throws Error, in which `name` stands for the file.
void unpackGltfViews(const GltfPacking& packing, tinygltf::Model& model, const std::string& name);

} // namespace relume
