#include "engine/import/moving_light.h"

#include "engine/base/check.h"
#include "engine/import/json_object.h"
#include "engine/import/light_track.h"
#include "engine/import/light_values.h"

#include <nlohmann/json.hpp>

namespace relume {

struct MovingLight::Description {
    nlohmann::json values;
};

namespace {

bool has(const nlohmann::json& description, const char* object, const char* key) {
    const auto found = description.find(object);
    return found != description.end() && found->is_object() && found->contains(key);
}

} // namespace

MovingLight::MovingLight(Light still) : mStill(std::move(still)) {}

MovingLight::MovingLight(std::string_view text, std::string name, std::filesystem::path folder)
    : mDescription(std::make_shared<Description>(Description{parseJson(text, name)})), mName(std::move(name)),
      mFolder(std::move(folder)) {
    const nlohmann::json& values = mDescription->values;
    const size_t keys = mostTrackKeys(values, mName);
    // Values between keys are within range if both keys are, so checking the keys suffices.
    for (size_t key = 0; key < std::max<size_t>(keys, 1); key++) read({withTrackKey(values, key)}, 0);
    mMoves = keys > 1 || (values.is_object() &&
                          (has(values, "environment", "sequence") || has(values, "blend", "sequence") ||
                           has(values, "sky", "hours_per_second")));
}

Light MovingLight::read(const Description& description, double seconds) {
    return makeLight(description.values, {mName, mFolder, seconds, mFiles});
}

Light MovingLight::at(double seconds) {
    RELUME_CHECK(seconds >= 0);
    return scaled(mDescription ? read({withTracksAt(mDescription->values, seconds)}, seconds) : mStill,
                  mGain);
}

} // namespace relume
