#include "engine/import/session_file.h"

#include "engine/import/json_object.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

using Json = nlohmann::json;
using Names = std::initializer_list<const char*>;

constexpr Names kFiles = {"bake", "model", "environment"},
                kTexts = {"size", "residual", "tone", "background", "ground-style"},
                kVectors = {"eye", "target"},
                kNumbers = {"fov",     "rotate", "coefficients", "threshold",      "time",
                            "samples", "terms",  "exposure",     "background-blur"};
constexpr float kLargest = 1e6f; // as for camera options

// Replaces a relative file name, if present, by its absolute path.
void place(Json& object, const char* key, const std::filesystem::path& folder) {
    if (object.contains(key) && object[key].is_string())
        object[key] =
            std::filesystem::absolute(folder / object[key].get<std::string>()).lexically_normal().string();
}

void checkTypes(const JsonObject& session) {
    for (const Names& keys : {kFiles, kTexts})
        for (const char* key : keys) session.text(key, "");
    for (const char* key : kVectors) session.requiredVector(key, -kLargest, kLargest);
    for (const char* key : kNumbers) session.number(key, 0, -kLargest, kLargest);
    const Json* const light = session.find("light");
    if (light && !light->is_object()) session.text("light", "");
    const Json* const material = session.find("material");
    if (material && (!material->is_array() || material->empty() ||
                     !std::ranges::all_of(*material, [](const Json& each) { return each.is_string(); })))
        session.fail("material", "a list of names, or of \"NAME=WEIGHT\"");
}

void refusePair(const JsonObject& session, const char* key, const char* other, const char* why) {
    if (session.find(key) && session.find(other)) session.fail(key, why);
}

} // namespace

nlohmann::json readSessionFile(const std::filesystem::path& path) {
    Json content = readJson(path);
    const JsonObject session(content, path.string(), kSessionKeys);
    if (session.requiredNumber("session", 1, kLargest) != 1)
        session.fail("session", "version 1, which this program knows");
    session.requiredText("bake", "a .relume file");
    checkTypes(session);
    refusePair(session, "environment", "light", "no such key beside \"light\"");
    refusePair(session, "threshold", "coefficients", "no such key beside \"coefficients\"");
    if (glm::distance(session.requiredVector("eye", -kLargest, kLargest),
                      session.requiredVector("target", -kLargest, kLargest)) == 0)
        session.fail("eye", "a point other than the target");

    const std::filesystem::path folder = path.parent_path();
    for (const char* key : kFiles) place(content, key, folder);
    place(content, "light", folder);
    if (content.contains("light") && content["light"].is_object())
        for (const char* part : {"environment", "blend"})
            if (Json& light = content["light"]; light.contains(part) && light[part].is_object())
                for (const char* key : {"file", "sequence"}) place(light[part], key, folder);
    return content;
}

} // namespace relume
