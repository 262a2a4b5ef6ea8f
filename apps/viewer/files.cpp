#include "apps/viewer/files.h"

#include "apps/viewer/opened_file.h"
#include "apps/viewer/outputs.h"
#include "engine/base/error.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

void Files::open(const std::filesystem::path& file) {
    const FileKind kind = kindOf(file);
    if (kind == FileKind::Bake || kind == FileKind::Bakeable) mSession.reset();
    if (kind != FileKind::Session) return mContent.open(file);
    const Session session = readSession(file, mState);
    mContent.open(session.opened);
    mSession = session;
    mState = session.state;
    mSessionBake = kindOf(session.opened) == FileKind::Bake ? session.opened : bakePath(session.opened);
    mContent.remember(file);
}

void Files::resumeSession() {
    if (!mSession || wholePath(mContent.shown()->file) != wholePath(mSessionBake)) return;
    mState.orbit = orbitOf(mSession->camera);
    mState.keepsOrbit = true;
    mState.material = mSession->material;
    mSession.reset();
}

std::string Files::saveLight(const std::filesystem::path& file) const {
    writeJsonFile(file, lightFileOf(mState.light));
    return fmt::format("{} is written; its turn is --rotate={}", file.string(), mState.light.rotation);
}

std::string Files::saveSession(const std::filesystem::path& file, const SceneState& drawn, GroundStyle ground,
                               ivec2 size) const {
    if (!mContent.shown() || !drawn.orbit) throw Error("nothing is shown yet that a session could keep");
    const std::filesystem::path& bake = mContent.shown()->file;
    writeJsonFile(file, sessionOf(drawn, ground, bake, mContent.inputOf(bake), size));
    return fmt::format("{0} is written; relume render --session {0} -o IMAGE draws it{1}", file.string(),
                       mContent.shown()->isSketch ? " once it is baked" : "");
}

} // namespace relume
