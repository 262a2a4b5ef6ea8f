// Conversion of a light file's values to a light: internal to engine/import. Defined in light_file.cpp.
#pragma once

#include "engine/import/environment_files.h"

#include <nlohmann/json_fwd.hpp>

namespace relume {

// The context in which a light file's values are evaluated at a time.
struct LightMoment {
    std::string name; // of the file, for errors
    std::filesystem::path folder;
    double seconds; // the time, for sequences and the sky
    EnvironmentFiles& files;
};

// Makes the light of a file's values, without tracks (light_track.h). Throws Error that names file and key.
Light makeLight(const nlohmann::json& values, const LightMoment& moment);

} // namespace relume
