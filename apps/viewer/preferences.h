// Settings that the program remembers between runs: viewer.json in the user's state folder.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace relume {

struct Preferences {
    std::optional<ivec2> size;                       // of the window
    std::vector<std::filesystem::path> recent;       // that were opened, newest first
    std::vector<std::filesystem::path> environments; // that can be chosen
    nlohmann::json settings = nlohmann::json::object();
};

// Returns what was remembered, without missing or invalid values.
Preferences readPreferences();

// Saves it; failure is logged as a warning.
void writePreferences(const Preferences& preferences);

} // namespace relume
