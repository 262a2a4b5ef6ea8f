#include "apps/relume/session_file.h"

#include "engine/base/error.h"
#include "engine/import/session_file.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

namespace {

std::string textOf(const nlohmann::json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

std::vector<std::string> resultsOf(const nlohmann::json& value) {
    if (!value.is_array()) return {textOf(value)};
    std::vector<std::string> results;
    for (const nlohmann::json& each : value) results.push_back(textOf(each));
    return results;
}

} // namespace

void applySession(const std::filesystem::path& file, CLI::App& command) {
    const nlohmann::json session = readSessionFile(file);
    const auto isGiven = [](const CLI::Option* option) { return option->count() > 0; };
    const CLI::Option* const background = command.get_option("--background");
    const CLI::Option* const blur = command.get_option("--background-blur");
    for (const auto& [key, value] : session.items()) {
        if (key == "session" || key == "model") continue; // the model is what the bake was made from
        // Only an environment is blurred. It is the default background of a picture, not of .exr; the command
        // may set another.
        if (key == "background-blur" &&
            (isGiven(background) || command.get_option("--output")->as<std::string>().ends_with(".exr")))
            continue;
        if (key == "background" && isGiven(blur)) continue;
        CLI::Option* const option = command.get_option("--" + key);
        if (isGiven(option) || std::ranges::any_of(option->get_excludes(), isGiven)) continue;
        try {
            option->add_result(resultsOf(value));
            option->run_callback();
        } catch (const std::exception& wrong) {
            throw Error(fmt::format("{}: \"{}\": {}", file.string(), key, wrong.what()));
        }
    }
}

} // namespace relume
