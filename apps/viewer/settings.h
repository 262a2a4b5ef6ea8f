// Settings as scripts give them and the program remembers them: docs/viewer.md lists them.
#pragma once

#include "apps/viewer/scene_state.h"

#include <nlohmann/json.hpp>

namespace relume {

// `model`: the bounds of what is shown, if there is anything; then `state` has its orbit. Throws Error for a
// setting that there is not, or a value that it cannot have.
void applySetting(SceneState& state, const std::string& name, const nlohmann::json& value,
                  const Bounds* model);

// Those that are the same the next time, by name.
nlohmann::json keptSettings(const SceneState& state);

} // namespace relume
