// What the program remembers from one time to the next: viewer.json in the user's state folder.
#pragma once

#include "engine/math/vector.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace relume {

struct Habits {
    std::optional<ivec2> size;                       // of the window
    std::vector<std::filesystem::path> recent;       // files that were opened, the newest first
    std::vector<std::filesystem::path> environments; // to choose from
    nlohmann::json settings = nlohmann::json::object();
};

// What there is of it: what is missing or makes no sense is left out.
Habits readHabits();

// Fails with a warning.
void writeHabits(const Habits& habits);

} // namespace relume
