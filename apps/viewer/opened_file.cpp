#include "apps/viewer/opened_file.h"

#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/import/json_object.h"

#include <algorithm>
#include <charconv>
#include <climits>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <set>

namespace relume {

namespace {

using nlohmann::json;

// Three materials that respond differently to light, close enough to be reflected in each other.
constexpr std::string_view kSceneText = R"({
  "parts": [
    {"name": "knot", "mesh": "knot", "material": "gold", "rotate": [75, 20, 0], "translate": [0, 0.93, 0]},
    {"name": "ball", "mesh": "sphere", "material": "red-plastic", "scale": 0.36,
     "translate": [-0.5, 0.36, 1]},
    {"name": "ring", "mesh": "torus", "material": "brushed-steel", "scale": 0.45,
     "translate": [0.8, 0.135, 0.75]}
  ],
  "ground": true
}
)";

// Decodes percent-encoded characters: "my%20house.bin" becomes "my house.bin" (RFC 3986, 2.1).
std::string decodeUri(const std::string& uri) {
    std::string text;
    for (size_t i = 0; i < uri.size(); i++) {
        unsigned code = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2)
            text += char(code), i += 2;
        else
            text += uri[i];
    }
    return text;
}

// Collects the path, date and size of files and of the files that they name. Another text() means that one of
// them has changed.
class FileStates {
  public:
    void add(const std::filesystem::path& file) {
        std::error_code failure;
        const auto changed = std::filesystem::last_write_time(file, failure);
        if (failure || !std::filesystem::is_regular_file(file, failure) || !mSeen.insert(file).second) return;
        // A date can stay the same: after a clock went back, or for a copy that keeps the date of its
        // original.
        const auto bytes = std::filesystem::file_size(file, failure);
        mText +=
            fmt::format("\n{} {} {}", file.string(), changed.time_since_epoch().count(), failure ? 0 : bytes);
        const std::string extension = extensionOf(file);
        if (extension != ".json" && extension != ".gltf") return;
        try {
            addNamed(readJson(file), file.parent_path());
        } catch (const Error&) { // the bake reports what is wrong with it
        }
    }
    const std::string& text() const { return mText; }

  private:
    void addNamed(const json& value, const std::filesystem::path& folder) {
        if (value.is_string()) {
            const auto& name = value.get_ref<const std::string&>();
            if (name.size() > PATH_MAX) return; // the text is data, not a name
            add((folder / name).lexically_normal());
            if (name.find('%') != std::string::npos) add((folder / decodeUri(name)).lexically_normal());
        } else if (value.is_structured())
            for (const json& part : value) addNamed(part, folder);
    }

    std::set<std::filesystem::path> mSeen;
    std::string mText;
};

FileKind kindOfJson(const std::filesystem::path& file) {
    const json content = readJson(file);
    if (!content.is_object())
        throw Error(fmt::format("{}: expected a JSON object: a scene, a light or a session", file.string()));
    if (content.contains("session")) return FileKind::Session;
    return content.contains("parts") ? FileKind::Bakeable : FileKind::Light;
}

} // namespace

std::string extensionOf(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

std::filesystem::path wholePath(const std::filesystem::path& file) {
    return std::filesystem::absolute(file).lexically_normal();
}

FileKind kindOf(const std::filesystem::path& file) {
    const std::string extension = extensionOf(file);
    if (extension == ".relume") return FileKind::Bake;
    if (extension == ".exr" || extension == ".hdr") return FileKind::Environment;
    if (extension == ".json") return kindOfJson(file);
    for (const char* mesh : {".obj", ".ply", ".gltf", ".glb"})
        if (extension == mesh) return FileKind::Bakeable;
    throw Error(fmt::format("{}: expected a bake (.relume), a mesh (.obj, .ply, .gltf, .glb), a scene, light "
                            "or session (.json) or an "
                            "environment (.exr, .hdr)",
                            file.string()));
}

std::filesystem::path writeBuiltInScene() {
    const std::filesystem::path file = cacheFolder() / fmt::format("{}.json", kBuiltInScene);
    const auto scene = std::as_bytes(std::span(kSceneText));
    std::error_code failure;
    // Write only what has changed: the file's date decides whether its bake is up to date.
    if (!std::filesystem::exists(file, failure) || !std::ranges::equal(readFile(file), scene))
        writeFileAtomically(file, scene);
    return file;
}

std::filesystem::path bakePath(const std::filesystem::path& input) {
    std::error_code failure;
    const std::filesystem::path folder = cacheFolder() / "bakes";
    std::filesystem::create_directories(folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot be made: {}", folder.string(), failure.message()));
    static_cast<void>(std::filesystem::file_size(input, failure)); // only whether it can be read
    if (failure) throw Error(fmt::format("{}: cannot be read: {}", input.string(), failure.message()));
    FileStates states;
    states.add(wholePath(input));
    const std::string hash = hashText(std::as_bytes(std::span(states.text())));
    return folder / fmt::format("{}-{}.relume", input.stem().string().substr(0, 100), hash.substr(0, 12));
}

} // namespace relume
