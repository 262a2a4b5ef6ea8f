// Light as it is from moment to moment.
#pragma once

#include "engine/import/environment_files.h"

#include <memory>
#include <string>
#include <string_view>

namespace relume {

class MovingLight {
  public:
    explicit MovingLight(Light still);

    // What a light file (docs/light_format.md) holds: `name` for errors, `folder` for the files it names.
    // Throws Error for text that is no JSON, and for values that are not as they should be at any time.
    MovingLight(std::string_view text, std::string name, std::filesystem::path folder);

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
    struct Description; // the text's values

    Light read(const Description& values, double seconds);

    Light mStill; // where there is no description
    std::shared_ptr<const Description> mDescription;
    std::string mName;
    std::filesystem::path mFolder;
    EnvironmentFiles mFiles;
    bool mMoves = false;
    float mGain = 1;
};

} // namespace relume
