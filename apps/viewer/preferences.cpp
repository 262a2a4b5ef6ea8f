#include "apps/viewer/preferences.h"

#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/import/json_object.h"

#include <spdlog/spdlog.h>

namespace relume {

namespace {

using nlohmann::json;

constexpr size_t kMostBytes = 1 << 20, kMostFiles = 64;

std::filesystem::path preferencesFile() { return stateFolder() / "viewer.json"; }

// Returns a member of an object; null if it is missing.
json memberOf(const json& object, const char* name) { return object.value(name, json()); }

std::vector<std::filesystem::path> filesOf(const json& list) {
    std::vector<std::filesystem::path> files;
    if (!list.is_array()) return files;
    std::error_code failure;
    for (const json& file : list)
        if (file.is_string() && files.size() < kMostFiles &&
            std::filesystem::exists(file.get<std::string>(), failure))
            files.emplace_back(file.get<std::string>());
    return files;
}

std::optional<ivec2> sizeOf(const json& width, const json& height) {
    if (!width.is_number_integer() || !height.is_number_integer()) return std::nullopt;
    const auto x = width.get<int64_t>(), y = height.get<int64_t>();
    if (x < 320 || y < 240 || x > 16384 || y > 16384) return std::nullopt;
    return ivec2(int(x), int(y));
}

json listOf(const std::vector<std::filesystem::path>& files) {
    json list = json::array();
    for (const std::filesystem::path& file : files) list.push_back(file.string());
    return list;
}

} // namespace

Preferences readPreferences() {
    Preferences preferences;
    try {
        const std::filesystem::path file = preferencesFile();
        if (!std::filesystem::exists(file)) return preferences;
        const std::vector<std::byte> bytes = readFile(file, kMostBytes);
        const json object =
            parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
        preferences.size = sizeOf(memberOf(object, "width"), memberOf(object, "height"));
        preferences.recent = filesOf(memberOf(object, "recent"));
        preferences.environments = filesOf(memberOf(object, "environments"));
        if (const json settings = memberOf(object, "settings"); settings.is_object())
            preferences.settings = settings;
    } catch (const std::exception& why) {
        spdlog::debug("what was remembered is left out: {}", why.what());
    }
    return preferences;
}

void writePreferences(const Preferences& preferences) {
    json object = {{"recent", listOf(preferences.recent)},
                   {"environments", listOf(preferences.environments)},
                   {"settings", preferences.settings}};
    if (preferences.size) object.update({{"width", preferences.size->x}, {"height", preferences.size->y}});
    try {
        writeFileAtomically(preferencesFile(),
                            object.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
    } catch (const std::exception& why) {
        spdlog::warn("settings are not remembered: {}", why.what());
    }
}

} // namespace relume
