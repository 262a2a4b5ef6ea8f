// Material presets: named models with parameters.
#pragma once

#include <span>

namespace relume {

struct PresetDefinition {
    const char* name;
    const char* description;
    const char* json; // as makeBrdf() reads it
};

std::span<const PresetDefinition> presetDefinitions();

} // namespace relume
