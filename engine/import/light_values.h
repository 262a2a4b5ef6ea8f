// From the values of a light file to light: internal to engine/import.
#pragma once

#include "engine/import/environment_files.h"

#include <nlohmann/json.hpp>

namespace relume {

// What the light of a file is made from at a moment.
struct LightMoment {
    std::string name; // of the file, for errors
    std::filesystem::path folder;
    double seconds; // of sequences and the sky's time
    EnvironmentFiles& files;
};

// `values`: the file's, without tracks (light_track.h). Throws Error that names file and field.
Light makeLight(const nlohmann::json& values, const LightMoment& moment);

} // namespace relume
