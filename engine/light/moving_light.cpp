#include "engine/light/moving_light.h"

#include "engine/base/check.h"
#include "engine/light/light_file.h"
#include "engine/light/light_track.h"

namespace relume {

namespace {

bool has(const nlohmann::json& description, const char* object, const char* key) {
    const auto found = description.find(object);
    return found != description.end() && found->is_object() && found->contains(key);
}

} // namespace

MovingLight::MovingLight(Light still) : mStill(std::move(still)) {}

MovingLight::MovingLight(nlohmann::json description, std::string name, std::filesystem::path folder)
    : mDescription(std::move(description)), mName(std::move(name)), mFolder(std::move(folder)) {
    const size_t keys = mostTrackKeys(mDescription, mName);
    // Between keys nothing is out of the range that both of them are in.
    for (size_t key = 0; key < std::max<size_t>(keys, 1); key++) read(withTrackKey(mDescription, key), 0);
    mMoves = keys > 1 || (mDescription.is_object() && (has(mDescription, "environment", "sequence") ||
                                                       has(mDescription, "blend", "sequence") ||
                                                       has(mDescription, "sky", "hours_per_second")));
}

Light MovingLight::read(const nlohmann::json& values, double seconds) {
    return readLight(values, {mName, mFolder, seconds, mFiles});
}

Light MovingLight::at(double seconds) {
    RELUME_CHECK(seconds >= 0);
    return scaled(mDescription.is_null() ? mStill : read(withTracksAt(mDescription, seconds), seconds),
                  mGain);
}

} // namespace relume
