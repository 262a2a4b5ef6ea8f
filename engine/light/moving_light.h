// Light as it is from moment to moment.
#pragma once

#include "engine/light/environment_files.h"

#include <nlohmann/json.hpp>

namespace relume {

class MovingLight {
  public:
    explicit MovingLight(Light still);

    // What a light file (docs/light_format.md) holds: `name` for errors, `folder` for the files it names.
    // Throws Error for values that are not as they should be at any time.
    MovingLight(nlohmann::json description, std::string name, std::filesystem::path folder);

    bool moves() const { return mMoves; }

    // At a time of at least 0. Throws Error when a sequence's file cannot be read.
    Light at(double seconds);

    // That the description names, the light file itself left out.
    const std::set<std::filesystem::path>& files() const { return mFiles.named(); }

    // Lets at() also return the full-resolution pictures that backgrounds need.
    void keepPictures() { mFiles.keepPictures(); }

    // Factor of all of it, at least 0.
    void setGain(float gain) { mGain = gain; }

  private:
    Light read(const nlohmann::json& values, double seconds);

    Light mStill;                // where there is no description
    nlohmann::json mDescription; // null, or an object
    std::string mName;
    std::filesystem::path mFolder;
    EnvironmentFiles mFiles;
    bool mMoves = false;
    float mGain = 1;
};

} // namespace relume
