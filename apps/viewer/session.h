// A look as a file: what is shown, from where, in which light and materials. `relume render --session` draws
// it, too. Format: docs/session_format.md.
#pragma once

#include "apps/viewer/scene_state.h"

#include <filesystem>
#include <nlohmann/json.hpp>

namespace relume {

// What a session shows, once it is open.
struct Session {
    std::filesystem::path opened; // a bake; or a mesh or scene, which is baked in view
    SceneState state;             // with its light and view
    Camera camera;                // these two once its model is there
    std::vector<WeightedMaterial> material;
};

// Returns the content of a session file. `state` has its orbit; `fadesGround`: SceneView::fadesGround();
// `input`: what the bake was made of in view, or empty.
nlohmann::ordered_json sessionOf(const SceneState& state, bool fadesGround, const std::filesystem::path& bake,
                                 const std::filesystem::path& input, ivec2 size);

// Reads a session file; what it does not say stays as in `state`. Throws Error.
Session readSession(const std::filesystem::path& file, const SceneState& state);

} // namespace relume
