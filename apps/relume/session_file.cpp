#include "apps/relume/session_file.h"

#include "engine/base/error.h"
#include "engine/base/nearest_name.h"
#include "engine/import/json_object.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

namespace {

using Json = nlohmann::json;

std::string textOf(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

// Names of files in a session start at its folder.
Json placed(const std::string& key, Json value, const std::filesystem::path& folder) {
    const bool isFile = key == "bake" || key == "environment" || key == "light";
    if (isFile && value.is_string()) value = (folder / value.get<std::string>()).string();
    if (key != "light" || !value.is_object()) return value;
    for (const char* each : {"environment", "blend"})
        if (value.contains(each) && value[each].is_object())
            for (const char* file : {"file", "sequence"})
                if (Json& part = value[each]; part.contains(file) && part[file].is_string())
                    part[file] = (folder / part[file].get<std::string>()).string();
    return value;
}

std::vector<std::string> resultsOf(const Json& value) {
    if (!value.is_array()) return {textOf(value)};
    std::vector<std::string> results;
    for (const Json& each : value) results.push_back(textOf(each));
    return results;
}

} // namespace

void applySession(const std::filesystem::path& file, CLI::App& command) {
    const Json session = readJson(file);
    if (!session.is_object() || session.value("session", Json()) != 1)
        throw Error(fmt::format("{}: expected a session, {{\"session\": 1, …}}, of the viewer's Ctrl + S",
                                file.string()));
    for (const auto& [key, value] : session.items()) {
        if (key == "session" || key == "model") continue; // the model is what the bake was made of
        CLI::Option* option = command.get_option_no_throw("--" + key);
        if (!option) {
            std::vector<std::string_view> names = {"bake"};
            for (const CLI::Option* known : command.get_options())
                for (const std::string& name : known->get_lnames()) names.push_back(name);
            throw Error(fmt::format("{}: there is no \"{}\"; did you mean \"{}\"? docs/session_format.md",
                                    file.string(), key, nearestName(key, names)));
        }
        const auto isGiven = [](const CLI::Option* other) { return other->count() > 0; };
        // Radiance has no background unless it is asked for.
        if (key == "background-blur" && !isGiven(command.get_option("--background")) &&
            command.get_option("--output")->as<std::string>().ends_with(".exr"))
            continue;
        if (isGiven(option) || std::ranges::any_of(option->get_excludes(), isGiven)) continue;
        try {
            option->add_result(resultsOf(placed(key, value, file.parent_path())));
            option->run_callback();
        } catch (const CLI::Error& wrong) {
            throw Error(fmt::format("{}: \"{}\": {}", file.string(), key, wrong.what()));
        }
    }
}

} // namespace relume
