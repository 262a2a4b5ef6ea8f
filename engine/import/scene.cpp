#include "engine/import/scene.h"
#include "engine/import/texture_file.h"

#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/mesh_file.h"
#include "engine/import/mesh_formats.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {
namespace {

// Makes a mesh of about 10,000 vertices, about two units across.
Mesh makeBuiltin(const std::string& name, bool hasUvs) {
    if (name == "sphere") return makeSphere(5, hasUvs);
    if (name == "torus") return makeTorus(0.7f, 0.3f, 160, 64, hasUvs);
    if (name == "knot") return makeKnot(12000, hasUvs);
    RELUME_CHECK_EQ(name, "plane");
    return makePlane(2, 100, hasUvs);
}

Part loadPart(const std::string& mesh, UpAxis up, const std::string& material, MeshAttributes wanted) {
    if (isBuiltinMesh(mesh)) {
        Part part{mesh, makeBuiltin(mesh, wanted.uvs), material, "built-in " + mesh, ""};
        if (up == UpAxis::Z) turnZUp(part.mesh);
        return part;
    }
    const std::filesystem::path path(mesh);
    const std::vector<std::byte> bytes = readFile(path);
    return {path.stem().string(), decodeMesh(bytes, path, up, wanted), material, mesh, hashText(bytes)};
}

std::vector<Part> loadOwnParts(const std::string& mesh, UpAxis up) {
    const std::filesystem::path path(mesh);
    const std::vector<std::byte> bytes = readFile(path);
    const std::string hash = hashText(bytes);
    GltfParts file = decodeGltfParts(bytes, path.parent_path(), mesh);
    std::vector<Part> parts;
    for (GltfPart& own : file.parts) {
        const bool isTinted = !own.mesh.colors.empty();
        parts.push_back({own.name, std::move(own.mesh), own.material, mesh, hash, std::move(own.baseColor),
                         std::move(own.materialMap)});
        parts.back().tintedByColors = isTinted;
        parts.back().detail = std::move(own.detail);
        if (up == UpAxis::Z) turnZUp(parts.back().mesh);
    }
    parts.front().textureFiles = std::move(file.images);
    return parts;
}

std::optional<Texture> loadTexture(const std::filesystem::path& path, bool srgb,
                                   std::vector<InputFile>& files) {
    if (path.empty()) return std::nullopt;
    const std::vector<std::byte> bytes = readFile(path, kLargestTextureFile);
    files.push_back({path.string(), hashText(bytes)});
    return decodeTexture(bytes, path.string(), srgb);
}

} // namespace

bool isBuiltinMesh(const std::string& name) {
    return name == "sphere" || name == "torus" || name == "knot" || name == "plane";
}

Bounds boundsOf(const Scene& scene) {
    Bounds bounds;
    for (const Part& part : scene.parts) bounds.add(boundsOf(part.mesh));
    return bounds;
}

void checkPlace(std::span<const Part> parts, const std::string& place) {
    constexpr float kMostSizes = 1e4f;
    Bounds bounds;
    for (const Part& part : parts) bounds.add(boundsOf(part.mesh));
    const vec3 extent = bounds.extent(), reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    const float size = std::max({extent.x, extent.y, extent.z}), away = std::max({reach.x, reach.y, reach.z});
    if (away > kMostSizes * size)
        throw Error(fmt::format(
            "{}: is {:g} units large and reaches {:g} from the origin: expected at most {:g} times "
            "its size, beyond which its shape is rounded; move it nearer",
            place, size, away, kMostSizes));
}

bool hasOwnMaterials(const std::string& mesh) { return !isBuiltinMesh(mesh) && isGltf(mesh); }

std::vector<Part> loadParts(const std::string& mesh, UpAxis up, const std::optional<std::string>& material,
                            const PartPaint& paint) {
    RELUME_CHECK(paint.materialMap.empty() || !paint.isByColors);
    if (!material && !hasOwnMaterials(mesh))
        throw Error(fmt::format("{}: has no materials of its own: name one", mesh));
    if (!material && paint.isAny())
        throw Error(fmt::format("{}: name the material that is to be painted", mesh));
    std::vector<Part> parts;
    if (material)
        parts.push_back(loadPart(mesh, up, *material, {.uvs = paint.usesUvs(), .colors = paint.isByColors}));
    else
        parts = loadOwnParts(mesh, up);
    checkPlace(parts, mesh);
    if (!material) return parts;
    Part& part = parts.front();
    if (paint.usesUvs() && part.mesh.uvs.empty())
        throw Error(fmt::format(
            "{}: has no texture coordinates, or not at every corner, which its textures need: unwrap it "
            "before export",
            mesh));
    if (paint.isByColors && part.mesh.colors.empty())
        throw Error(fmt::format(
            "{}: has no vertex colors, or not at every vertex: paint it before export (as PLY or glTF)",
            mesh));
    part.baseColor = loadTexture(paint.baseColor, true, part.textureFiles);
    part.materialMap = loadTexture(paint.materialMap, false, part.textureFiles);
    part.paintedByColors = paint.isByColors;
    return parts;
}

void addGround(Scene& scene, const GroundOptions& options, const std::string& material) {
    RELUME_CHECK(!scene.parts.empty());
    if (options.tessellation < 1 || options.tessellation > kMostGroundQuads)
        throw UsageError(fmt::format("a ground of {} quads a side: expected 1 to {}", options.tessellation,
                                     kMostGroundQuads));
    if (!(options.extent >= kSmallestGroundExtent && options.extent <= kLargestGroundExtent))
        throw UsageError(fmt::format("a ground {} times as large as the object: expected {} to {}",
                                     options.extent, kSmallestGroundExtent, kLargestGroundExtent));
    scene.parts.push_back({"ground", makeGround(boundsOf(scene), options), material, "built-in ground", ""});
    scene.parts.back().keepsVertices = !options.isRefinable;
}

} // namespace relume
