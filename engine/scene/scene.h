// What is baked: parts, each a mesh with a material.
#pragma once

#include "engine/scene/ground.h"
#include "engine/scene/mesh.h"

#include <filesystem>
#include <string>
#include <vector>

namespace relume {

enum class UpAxis { Y, Z };

// One surface. Its transform is already applied to the mesh.
struct Part {
    std::string name;
    Mesh mesh;
    std::string material;   // A preset's name, or a JSON object {"model": …, parameters…}, as text.
    std::string source;     // The file it came from, or "built-in NAME"; for provenance.
    std::string sourceHash; // hashText of that file's bytes; empty for built-in meshes.
};

struct Scene {
    std::vector<Part> parts;
};

Bounds boundsOf(const Scene& scene);

// Whether `name` is "sphere", "torus", "knot" or "plane".
bool isBuiltinMesh(const std::string& name);

// The part made of a mesh file or of a built-in mesh, with its source and hash filled in. Throws Error as
// readMesh does.
Part loadPart(const std::string& mesh, UpAxis up, const std::string& material);

// Adds a ground, sized by what is in the scene so far, which must not be empty. Throws UsageError for options
// out of range.
void addGround(Scene& scene, const GroundOptions& options, const std::string& material = "white-diffuse");

// Reads a scene file (JSON: docs/scene_format.md). Mesh paths in it are relative to its folder.
// Throws Error naming file, key and remedy.
Scene readScene(const std::filesystem::path& path);

} // namespace relume
