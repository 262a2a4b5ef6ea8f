// What is baked: parts, each a mesh with a material.
#pragma once

#include "engine/import/ground.h"
#include "engine/import/input_file.h"
#include "engine/scene/mesh.h"
#include "engine/scene/surface_detail.h"
#include "engine/scene/texture.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace relume {

enum class UpAxis { Y, Z };

// What a mesh without materials of its own is made of, where none is named.
constexpr const char* kDefaultMaterial = "gold";

constexpr float kLargestBrushRotation = 36000; // degrees, either way

// One surface. Its transform is already applied to the mesh.
struct Part {
    std::string name;
    Mesh mesh;
    std::string material;   // As readMaterials() takes it: precompute/brdf/material_list.h.
    std::string source;     // The file it came from, or "built-in NAME"; for provenance.
    std::string sourceHash; // hashText of that file's bytes; empty for built-in meshes.
    std::optional<Texture> baseColor = std::nullopt; // By mesh.uvs; multiplies the material's base color.
    std::optional<Texture> materialMap =
        std::nullopt;             // By mesh.uvs: weights of the set's first four materials.
    bool paintedByColors = false; // Whether mesh.colors are these weights instead.
    bool tintedByColors = false;  // Whether mesh.colors multiply the material's base color.
    SurfaceDetail detail = {};
    std::filesystem::path materialFolder = {}; // Where relative paths in `material` start.
    std::vector<InputFile> textureFiles = {};  // What the textures came from, unless `source` holds them.
    float brushRotation = 0;    // Degrees that tangents are turned by about the normals, counter-clockwise.
    bool keepsVertices = false; // Whether automatic refinement leaves it: its tessellation was asked for.
};

// What a part is painted with.
struct PartPaint {
    std::filesystem::path baseColor, materialMap; // Image files; empty for none.
    bool isByColors = false;                      // Vertex colors instead of a material map.

    bool usesUvs() const { return !baseColor.empty() || !materialMap.empty(); }
    bool isAny() const { return usesUvs() || isByColors; }
};

struct Scene {
    std::vector<Part> parts;
};

Bounds boundsOf(const Scene& scene);

// Throws Error, in which `place` names the parts, if they are further from the origin than 10,000 times their
// size: single precision rounds their shape there, by a thousandth and more.
void checkPlace(std::span<const Part> parts, const std::string& place);

// Whether `name` is "sphere", "torus", "knot" or "plane".
bool isBuiltinMesh(const std::string& name);

// Whether a mesh has materials of its own: a glTF file, that is.
bool hasOwnMaterials(const std::string& mesh);

// The parts made of a mesh file or of a built-in mesh, with source and hashes filled in: one of this material
// and paint; or, if there is no material, one for each of the mesh's own. Throws Error as readMesh and
// readTexture do, when the mesh lacks the texture coordinates or colors that the paint needs, when it has no
// materials of its own but must, and for paint on these.
std::vector<Part> loadParts(const std::string& mesh, UpAxis up, const std::optional<std::string>& material,
                            const PartPaint& paint = {});

// Adds a ground, sized by what is in the scene so far, which must not be empty. Throws UsageError for options
// out of range.
void addGround(Scene& scene, const GroundOptions& options, const std::string& material = "white-diffuse");

// Reads a scene file (JSON: docs/scene_format.md). Mesh paths in it are relative to its folder. `ground`:
// what a ground is like where the file does not say it. Throws Error naming file, key and remedy.
Scene readScene(const std::filesystem::path& path, const GroundOptions& ground = {});

} // namespace relume
