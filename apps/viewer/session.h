// Sessions: what is shown, from where, in which light and materials, as a file that `relume render --session`
// draws, too (docs/session_format.md).
#pragma once

#include "apps/viewer/scene_state.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace relume {

// The content of a session file.
struct Session {
    std::filesystem::path opened; // a bake; or a mesh or scene, which the viewer bakes
    SceneState state;             // including light and view
    Camera camera;                // applied, like `material`, once the model is there
    std::vector<WeightedMaterial> material;
};

// Returns the content of a session file. `state` must have an orbit; `ground` is from
// SceneView::groundStyle(); `input` is the file from which the viewer made the bake, or empty.
nlohmann::ordered_json sessionOf(const SceneState& state, GroundStyle ground,
                                 const std::filesystem::path& bake, const std::filesystem::path& input,
                                 ivec2 size);

// Reads a session file; what it does not mention stays as in `state`. Throws Error.
Session readSession(const std::filesystem::path& file, const SceneState& state);

} // namespace relume
