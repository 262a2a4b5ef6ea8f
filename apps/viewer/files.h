// Opens and saves the viewer's files: models, environments, lights and sessions.
#pragma once

#include "apps/viewer/content.h"
#include "apps/viewer/session.h"

namespace relume {

class Files {
  public:
    // Keeps references to both.
    Files(SceneState& state, Content& content) : mState(state), mContent(content) {}

    // Begins to open a file of any kind that kindOf() knows. Throws Error.
    void open(const std::filesystem::path& file);

    // Call it when a model is shown: a session that waits for this one gets its camera and materials.
    void resumeSession();

    // Write the light or the look to `file`. `drawn`, `ground`: SceneView's. Return what to tell the
    // user. Throw Error.
    std::string saveLight(const std::filesystem::path& file) const;
    std::string saveSession(const std::filesystem::path& file, const SceneState& drawn, GroundStyle ground,
                            ivec2 size) const;

  private:
    SceneState& mState;
    Content& mContent;
    std::optional<Session> mSession; // waits for the model of this bake
    std::filesystem::path mSessionBake;
};

} // namespace relume
