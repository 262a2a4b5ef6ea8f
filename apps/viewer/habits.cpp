#include "apps/viewer/habits.h"

#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/file.h"

#include <spdlog/spdlog.h>

namespace relume {

namespace {

using nlohmann::json;

constexpr size_t kMostBytes = 1 << 20, kMostFiles = 64;

std::filesystem::path habitsFile() { return stateFolder() / "viewer.json"; }

std::vector<std::filesystem::path> filesOf(const json& object, const char* name) {
    std::vector<std::filesystem::path> files;
    const json list = object.value(name, json::array());
    for (const json& file : list)
        if (file.is_string() && files.size() < kMostFiles && std::filesystem::exists(file.get<std::string>()))
            files.emplace_back(file.get<std::string>());
    return files;
}

json listOf(const std::vector<std::filesystem::path>& files) {
    json list = json::array();
    for (const std::filesystem::path& file : files) list.push_back(file.string());
    return list;
}

} // namespace

Habits readHabits() {
    Habits habits;
    try {
        const std::filesystem::path file = habitsFile();
        if (!std::filesystem::exists(file)) return habits;
        const std::vector<std::byte> bytes = readFile(file, kMostBytes);
        const char* const text = reinterpret_cast<const char*>(bytes.data());
        const json object = json::parse(text, text + bytes.size());
        const ivec2 size(object.at("width").get<int>(), object.at("height").get<int>());
        if (size.x >= 320 && size.y >= 240 && size.x <= 16384 && size.y <= 16384) habits.size = size;
        habits.recent = filesOf(object, "recent");
        habits.environments = filesOf(object, "environments");
        habits.settings = object.value("settings", json::object());
        if (!habits.settings.is_object()) habits.settings = json::object();
    } catch (const std::exception& why) {
        spdlog::debug("what was remembered is left out: {}", why.what());
    }
    return habits;
}

void writeHabits(const Habits& habits) {
    json object = {{"recent", listOf(habits.recent)},
                   {"environments", listOf(habits.environments)},
                   {"settings", habits.settings}};
    if (habits.size) object.update({{"width", habits.size->x}, {"height", habits.size->y}});
    try {
        writeFileAtomically(habitsFile(), object.dump(2) + "\n");
    } catch (const std::exception& why) {
        spdlog::warn("settings are not remembered: {}", why.what());
    }
}

} // namespace relume
