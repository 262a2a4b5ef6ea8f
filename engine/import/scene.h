// Scenes to be baked: parts, each a mesh with a material.
#pragma once

#include "engine/import/builtin_mesh.h"
#include "engine/scene/mesh.h"
#include "engine/scene/surface_detail.h"
#include "engine/scene/texture.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace relume {

// An input file, for provenance.
struct InputFile {
    std::string file;
    std::string hash; // hashText of its bytes
};

enum class UpAxis { Y, Z };

// The material of a mesh that has none of its own, by default.
constexpr const char* kDefaultMaterial = "gold";

constexpr float kLargestBrushRotation = 36000; // degrees, either way

// One surface. Its transform is already applied to the mesh.
struct Part {
    std::string name;
    Mesh mesh;
    std::string material;   // as readMaterials() takes it: precompute/brdf/material_list.h
    std::string source;     // the file it came from, or "built-in NAME"; for provenance
    std::string sourceHash; // hashText() of that file's bytes; empty for built-in meshes
    std::optional<Texture> baseColor = std::nullopt;   // at mesh.uvs; multiplies the material's base color
    std::optional<Texture> materialMap = std::nullopt; // at mesh.uvs: weights of a set's first four materials
    bool paintedByColors = false;                      // whether mesh.colors are these weights instead
    bool tintedByColors = false; // whether mesh.colors multiply the material's base color
    SurfaceDetail detail = {};
    std::filesystem::path materialFolder = {}; // where relative paths in `material` start
    std::vector<InputFile> textureFiles = {};  // the textures' files, unless `source` holds them
    float brushRotation = 0;    // degrees, counter-clockwise, by which tangents turn about normals
    bool keepsVertices = false; // whether refinement leaves it, as its tessellation was asked for
};

// The textures or colors that a part is painted with.
struct PartPaint {
    std::filesystem::path baseColor, materialMap; // image files; empty for none
    bool isByColors = false;                      // vertex colors instead of a material map

    bool usesUvs() const { return !baseColor.empty() || !materialMap.empty(); }
    bool isAny() const { return usesUvs() || isByColors; }
};

struct Scene {
    std::vector<Part> parts;
};

Bounds boundsOf(const Scene& scene);

// Throws Error, in which `place` names the parts, if they reach further from the origin than 10,000 times
// their size: single precision would round their shape there by a thousandth and more.
void checkPlace(std::span<const Part> parts, const std::string& place);

// Returns whether `name` is "sphere", "torus", "knot" or "plane".
bool isBuiltinMesh(const std::string& name);

// Returns whether a mesh has materials of its own, as glTF files have.
bool hasOwnMaterials(const std::string& mesh);

// Loads a mesh file or a built-in mesh as parts, with source and hashes filled in: one part of this material
// and paint, or without a material one part for each of the mesh's own. Throws Error as readMesh() and
// readTexture() do; if the mesh lacks the texture coordinates or colors that the paint needs; if it needs
// materials of its own and has none; and for paint on a mesh's own materials.
std::vector<Part> loadParts(const std::string& mesh, UpAxis up, const std::optional<std::string>& material,
                            const PartPaint& paint = {});

// Adds a ground, sized by the scene so far, which is not empty. Throws UsageError for options out of range.
void addGround(Scene& scene, const GroundOptions& options, const std::string& material = "white-diffuse");

// Reads a scene file (JSON: docs/scene_format.md), in which mesh paths are relative to its folder. `ground`
// has the defaults for a ground. Throws Error that names file, key and remedy.
Scene readScene(const std::filesystem::path& path, const GroundOptions& ground = {});

} // namespace relume
