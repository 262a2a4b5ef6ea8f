// Arrays out of glTF accessors, every offset checked (glTF 2.0, 3.6.2).
#pragma once

#include "engine/math/vector.h"

#include <span>
#include <string>
#include <tiny_gltf.h>
#include <vector>

namespace relume {

// Elements of accessor number `index`, which must be VEC3 or VEC2; integers are normalized if it says so.
// Throws Error, in which `name` stands for the file, for anything out of bounds.
std::vector<vec3> readGltfVectors(const tinygltf::Model& model, int index, const std::string& name);
std::vector<vec2> readGltfUvs(const tinygltf::Model& model, int index, const std::string& name);

// The same of VEC4 or VEC3: colors and tangents. What VEC3 does not say is 0: colors serve as weights.
std::vector<vec4> readGltfFourVectors(const tinygltf::Model& model, int index, const std::string& name);

// The bytes of buffer view number `index`.
std::span<const unsigned char> gltfViewBytes(const tinygltf::Model& model, int index,
                                             const std::string& name);

// Elements of accessor number `index`, which must be SCALAR and unsigned.
std::vector<uint32_t> readGltfIndices(const tinygltf::Model& model, int index, const std::string& name);

} // namespace relume
