// Settings by name, for scripts and for remembering them (docs/viewer.md).
#pragma once

#include "apps/viewer/scene_state.h"

#include <nlohmann/json_fwd.hpp>

namespace relume {

// Applies a setting. `model` is the bounds of the model shown, null if none; with a model, `state` has an
// orbit. Throws Error for an unknown setting or invalid value.
void applySetting(SceneState& state, const std::string& name, const nlohmann::json& value,
                  const Bounds* model);

// Returns, by name, the settings that are remembered between runs.
nlohmann::json rememberedSettings(const SceneState& state);

} // namespace relume
