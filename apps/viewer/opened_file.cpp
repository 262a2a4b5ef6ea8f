#include "apps/viewer/opened_file.h"

#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

bool isScene(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, 16 << 20);
    const char* const text = reinterpret_cast<const char*>(bytes.data());
    const nlohmann::json content = nlohmann::json::parse(text, text + bytes.size(), nullptr, false);
    if (!content.is_object()) throw Error("{}: expected a JSON object: a scene or a light", file.string());
    return content.contains("parts");
}

} // namespace

FileKind kindOf(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".relume") return FileKind::Bake;
    if (extension == ".exr" || extension == ".hdr") return FileKind::Environment;
    if (extension == ".json") return isScene(file) ? FileKind::Bakeable : FileKind::Light;
    for (const char* mesh : {".obj", ".ply", ".gltf", ".glb"})
        if (extension == mesh) return FileKind::Bakeable;
    throw Error(
        "{}: expected a bake (.relume), a mesh (.obj, .ply, .gltf, .glb), a scene or light (.json) or an "
        "environment (.exr, .hdr)",
        file.string());
}

std::filesystem::path bakePath(const std::filesystem::path& input) {
    std::error_code failure;
    const std::filesystem::path folder = cacheFolder() / "bakes";
    std::filesystem::create_directories(folder, failure);
    if (failure) throw Error("{}: cannot be made: {}", folder.string(), failure.message());
    if (input.empty()) return folder / "built-in.relume";
    const std::filesystem::path whole = std::filesystem::absolute(input);
    const auto changed = std::filesystem::last_write_time(whole, failure);
    if (failure) throw Error("{}: cannot be read: {}", input.string(), failure.message());
    const std::string identity = fmt::format("{}\n{}", whole.string(), changed.time_since_epoch().count());
    const std::string hash = hashText(std::as_bytes(std::span(identity)));
    return folder / fmt::format("{}-{}.relume", input.stem().string(), hash.substr(0, 12));
}

} // namespace relume
