// Reads the JSON of docs/scene_format.md.
#include "engine/base/error.h"
#include "engine/import/json_object.h"
#include "engine/import/mesh_cleanup.h"
#include "engine/import/scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <nlohmann/json.hpp>

namespace relume {
namespace {

using Json = nlohmann::json;

constexpr const char* kMaterial = "a preset's name or an object {\"model\": …}";

// Returns a preset's name, or an object as JSON text; none if not given.
std::optional<std::string> materialOf(const JsonObject& object) {
    const Json* value = object.find("material");
    if (value && value->is_object()) return value->dump(-1, ' ', false, Json::error_handler_t::replace);
    if (value && !value->is_string()) object.fail("material", kMaterial);
    return value ? std::optional(object.text("material", "")) : std::nullopt;
}

// Scales, then rotates about x, y and z in this order, then translates.
void transform(Mesh& mesh, vec3 translation, vec3 degrees, float scale, const std::string& place) {
    mat4 turn(1);
    for (int axis = 2; axis >= 0; axis--) {
        vec3 direction(0);
        direction[axis] = 1;
        turn = glm::rotate(turn, glm::radians(degrees[axis]), direction);
    }
    const mat3 rotation(turn);
    for (vec3& position : mesh.positions) {
        position = rotation * (scale * position) + translation;
        if (glm::any(glm::greaterThan(glm::abs(position), vec3(kLargestCoordinate))))
            throw Error(fmt::format("{}: reaches beyond ±{:g} once placed: choose a smaller \"scale\"", place,
                                    kLargestCoordinate));
    }
    for (vec3& normal : mesh.normals) normal = glm::normalize(rotation * normal);
    for (vec3& tangent : mesh.tangents) tangent = rotation * tangent;
}

PartPaint readPaint(const JsonObject& node, const std::filesystem::path& folder) {
    PartPaint paint;
    if (node.find("base_color")) paint.baseColor = folder / node.text("base_color", "");
    const std::string map = node.text("material_map", "");
    paint.isByColors = map == "colors";
    if (!map.empty() && !paint.isByColors) paint.materialMap = folder / map;
    return paint;
}

// Renames parts: a single one to `name`, several to `name` followed by their own.
void renameParts(std::vector<Part>& parts, const std::string& name) {
    if (name.empty()) return;
    for (Part& part : parts) part.name = parts.size() == 1 ? name : name + ": " + part.name;
}

std::vector<Part> readParts(const Json& json, const std::string& place, const std::filesystem::path& folder) {
    static constexpr std::string_view kKeys[] = {"name",         "mesh",          "up",       "translate",
                                                 "rotate",       "scale",         "material", "base_color",
                                                 "material_map", "brush_rotation"};
    const JsonObject node(json, place, kKeys);
    const std::string mesh = node.text("mesh", "");
    if (mesh.empty()) node.fail("mesh", "a mesh file, or one of sphere, torus, knot, plane");
    const std::optional<std::string> material = materialOf(node);
    const PartPaint paint = readPaint(node, folder);
    if (!material && (paint.isAny() || !hasOwnMaterials(mesh))) node.fail("material", kMaterial);
    const std::string up = node.text("up", "y");
    if (up != "y" && up != "z") node.fail("up", "\"y\" or \"z\"");
    const vec3 translation = node.vector("translate", vec3(0), -kLargestCoordinate, kLargestCoordinate),
               degrees = node.vector("rotate", vec3(0), -36000, 36000);
    const float scale = node.number("scale", 1, 1e-9f, 1e9f);

    const std::string source = isBuiltinMesh(mesh) ? mesh : (folder / mesh).string();
    std::vector<Part> parts = loadParts(source, up == "z" ? UpAxis::Z : UpAxis::Y, material, paint);
    renameParts(parts, node.text("name", ""));
    const float brushRotation =
        node.number("brush_rotation", 0, -kLargestBrushRotation, kLargestBrushRotation);
    for (Part& part : parts) {
        transform(part.mesh, translation, degrees, scale, place);
        part.brushRotation = brushRotation;
    }
    checkPlace(parts, place);
    return parts;
}

void readGround(const Json& json, const std::string& place, GroundOptions options, Scene& scene) {
    static constexpr std::string_view kKeys[] = {"tessellation", "extent", "material"};
    static const Json kDefaults = Json::object();
    if (json.is_boolean() && !json.get<bool>()) return;
    const JsonObject node(json.is_boolean() ? kDefaults : json, place, kKeys);
    const float quads = node.number("tessellation", float(options.tessellation), 1, kMostGroundQuads);
    if (quads != std::floor(quads)) node.fail("tessellation", "a whole number");
    options.tessellation = int(quads);
    if (node.find("tessellation")) options.isRefinable = false;
    options.extent = node.number("extent", options.extent, kSmallestGroundExtent, kLargestGroundExtent);
    addGround(scene, options, materialOf(node).value_or("white-diffuse"));
}

} // namespace

Scene readScene(const std::filesystem::path& path, const GroundOptions& ground) {
    static constexpr std::string_view kKeys[] = {"parts", "ground"};
    const std::string name = path.string();
    const Json document = readJson(path);
    const JsonObject root(document, name, kKeys);
    const Json* parts = root.find("parts");
    if (!parts || !parts->is_array() || parts->empty()) root.fail("parts", "a list of one part or more");
    Scene scene;
    for (size_t i = 0; i < parts->size(); i++)
        std::ranges::move(readParts((*parts)[i], fmt::format("{}: parts[{}]", name, i), path.parent_path()),
                          std::back_inserter(scene.parts));
    if (const Json* own = root.find("ground")) readGround(*own, name + ": ground", ground, scene);
    for (Part& part : scene.parts) part.materialFolder = path.parent_path();
    return scene;
}

} // namespace relume
