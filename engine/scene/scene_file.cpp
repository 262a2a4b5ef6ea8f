// The JSON of docs/scene_format.md.
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/nearest_name.h"
#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <nlohmann/json.hpp>

namespace relume {
namespace {

using Json = nlohmann::json;

constexpr size_t kLargestSceneFile = size_t(16) << 20;
constexpr float kLargestCoordinate = 1e9f; // as in mesh files
constexpr const char* kMaterial = "a preset's name or an object {\"model\": …}";

Json parse(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = readFile(path, kLargestSceneFile);
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    try {
        return Json::parse(text, text + bytes.size(), [&](int depth, Json::parse_event_t, Json&) {
            if (depth > 32) throw Error("{}: is nested deeper than any scene file", path.string());
            return true;
        });
    } catch (const Json::exception& failure) {
        throw Error("{}: is not valid JSON: {}", path.string(), failure.what());
    }
}

// One object of the file, and where it is: for errors.
class Node {
  public:
    Node(const Json& json, std::string place, std::span<const std::string_view> keys)
        : mJson(json), mPlace(std::move(place)) {
        if (!json.is_object())
            throw Error("{}: expected an object {{…}}, found {}", mPlace, json.type_name());
        for (const auto& [key, value] : json.items())
            if (std::find(keys.begin(), keys.end(), key) == keys.end())
                throw Error("{}: unknown key \"{}\": did you mean \"{}\"? Valid keys are {}", mPlace,
                            key.substr(0, 40), nearestName(key, keys), fmt::join(keys, ", "));
    }

    // Null when the key is not there.
    const Json* find(const char* key) const {
        const auto found = mJson.find(key);
        return found == mJson.end() ? nullptr : &*found;
    }

    [[noreturn]] void fail(const char* key, std::string_view expected) const {
        const Json* value = find(key);
        std::string found = value ? value->dump(-1, ' ', false, Json::error_handler_t::replace) : "nothing";
        if (found.size() > 60) found = found.substr(0, 60) + "…";
        throw Error("{}: \"{}\": expected {}, found {}", mPlace, key, expected, found);
    }

    std::string text(const char* key, const std::string& fallback) const {
        const Json* value = find(key);
        if (!value) return fallback;
        if (!value->is_string() || value->get_ref<const std::string&>().empty()) fail(key, "a text");
        return value->get<std::string>();
    }

    float number(const char* key, float fallback, float low, float high) const {
        const Json* value = find(key);
        return value ? check(key, *value, low, high) : fallback;
    }

    vec3 vector(const char* key, float limit) const {
        const Json* value = find(key);
        if (!value) return vec3(0);
        if (!value->is_array() || value->size() != 3) fail(key, "three numbers [x, y, z]");
        return {check(key, (*value)[0], -limit, limit), check(key, (*value)[1], -limit, limit),
                check(key, (*value)[2], -limit, limit)};
    }

    // A preset's name, or an object as text.
    std::optional<std::string> material() const {
        const Json* value = find("material");
        if (value && value->is_object()) return value->dump(-1, ' ', false, Json::error_handler_t::replace);
        if (value && !value->is_string()) fail("material", kMaterial);
        return value ? std::optional(text("material", "")) : std::nullopt;
    }

  private:
    float check(const char* key, const Json& value, float low, float high) const {
        const float number = value.is_number() ? value.get<float>() : NAN;
        if (!(number >= low && number <= high))
            fail(key, fmt::format("numbers from {:g} to {:g}", low, high));
        return number;
    }

    const Json& mJson;
    std::string mPlace;
};

// Scales, then turns about x, y and z in this order, then moves.
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
            throw Error("{}: reaches beyond ±{:g} once placed: choose a smaller \"scale\"", place,
                        kLargestCoordinate);
    }
    for (vec3& normal : mesh.normals) normal = glm::normalize(rotation * normal);
}

PartPaint readPaint(const Node& node, const std::filesystem::path& folder) {
    PartPaint paint;
    if (node.find("base_color")) paint.baseColor = folder / node.text("base_color", "");
    const std::string map = node.text("material_map", "");
    paint.isByColors = map == "colors";
    if (!map.empty() && !paint.isByColors) paint.materialMap = folder / map;
    return paint;
}

// The parts' names: the mesh's or the one given, which several parts share as a first half.
void renameParts(std::vector<Part>& parts, const std::string& name) {
    if (name.empty()) return;
    for (Part& part : parts) part.name = parts.size() == 1 ? name : name + ": " + part.name;
}

std::vector<Part> readParts(const Json& json, const std::string& place, const std::filesystem::path& folder) {
    static constexpr std::string_view kKeys[] = {"name",  "mesh",     "up",         "translate",   "rotate",
                                                 "scale", "material", "base_color", "material_map"};
    const Node node(json, place, kKeys);
    const std::string mesh = node.text("mesh", "");
    if (mesh.empty()) node.fail("mesh", "a mesh file, or one of sphere, torus, knot, plane");
    const std::optional<std::string> material = node.material();
    const PartPaint paint = readPaint(node, folder);
    if (!material && (paint.isAny() || !hasOwnMaterials(mesh))) node.fail("material", kMaterial);
    const std::string up = node.text("up", "y");
    if (up != "y" && up != "z") node.fail("up", "\"y\" or \"z\"");
    const vec3 translation = node.vector("translate", kLargestCoordinate),
               degrees = node.vector("rotate", 36000);
    const float scale = node.number("scale", 1, 1e-9f, 1e9f);

    const std::string source = isBuiltinMesh(mesh) ? mesh : (folder / mesh).string();
    std::vector<Part> parts = loadParts(source, up == "z" ? UpAxis::Z : UpAxis::Y, material, paint);
    renameParts(parts, node.text("name", ""));
    for (Part& part : parts) transform(part.mesh, translation, degrees, scale, place);
    return parts;
}

void readGround(const Json& json, const std::string& place, Scene& scene) {
    static constexpr std::string_view kKeys[] = {"tessellation", "extent", "material"};
    static const Json kDefaults = Json::object();
    if (json.is_boolean() && !json.get<bool>()) return;
    const Node node(json.is_boolean() ? kDefaults : json, place, kKeys);
    GroundOptions options;
    const float quads = node.number("tessellation", float(options.tessellation), 1, kMostGroundQuads);
    if (quads != std::floor(quads)) node.fail("tessellation", "a whole number");
    options.tessellation = int(quads);
    options.extent = node.number("extent", options.extent, kSmallestGroundExtent, kLargestGroundExtent);
    addGround(scene, options, node.material().value_or("white-diffuse"));
}

} // namespace

Scene readScene(const std::filesystem::path& path) {
    static constexpr std::string_view kKeys[] = {"parts", "ground"};
    const std::string name = path.string();
    const Json document = parse(path);
    const Node root(document, name, kKeys);
    const Json* parts = root.find("parts");
    if (!parts || !parts->is_array() || parts->empty()) root.fail("parts", "a list of one part or more");
    Scene scene;
    for (size_t i = 0; i < parts->size(); i++)
        std::ranges::move(readParts((*parts)[i], fmt::format("{}: parts[{}]", name, i), path.parent_path()),
                          std::back_inserter(scene.parts));
    if (const Json* ground = root.find("ground")) readGround(*ground, name + ": ground", scene);
    for (Part& part : scene.parts) part.materialFolder = path.parent_path();
    return scene;
}

} // namespace relume
