// Light as files describe it: docs/light_format.md.
#pragma once

#include "engine/light/moving_light.h"

namespace relume {

// Throws Error that names file and field.
MovingLight readLight(const std::filesystem::path& path);

// What the light of a file is made from at a moment.
struct LightMoment {
    std::string name; // of the file, for errors
    std::filesystem::path folder;
    double seconds; // of sequences and the sky's time
    EnvironmentFiles& files;
};

// `values`: the file's, without tracks (light_track.h). Throws Error that names file and field.
Light readLight(const nlohmann::json& values, const LightMoment& moment);

} // namespace relume
