// The triangles of a glTF scene.
#pragma once

#include "engine/scene/mesh.h"

#include <functional>
#include <map>
#include <string>
#include <tiny_gltf.h>

namespace relume {

// The attributes to keep of the vertices of one material, besides positions and normals.
struct GltfWish {
    MeshAttributes attributes;
    bool isTint = false; // colors multiply others: where there are none that can be read, they are white
    int uvSet = 0;       // the N of TEXCOORD_N
    mat3 uvTransform = mat3(1); // of (u, v, 1)
    // The angle that the material turns tangents by, from the tangent towards the bitangent.
    float brushRotation = 0;
};

// The wish for a material number, -1 where a primitive has none.
using GltfWishes = std::function<GltfWish(int material)>;

// The default scene (or the first) as one mesh for each material number, node transforms applied, unchecked
// but for indices. A mesh has a normal or tangent of length zero where the file has none, and fewer uvs or
// colors than vertices where a primitive lacks what is wished for. Throws Error, in which `name` stands for
// the file.
std::map<int, Mesh> readGltfGeometry(const tinygltf::Model& model, const GltfWishes& requests,
                                     const std::string& name);

} // namespace relume
