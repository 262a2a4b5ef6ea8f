// Light that may change over time.
#pragma once

#include "engine/import/environment_files.h"

#include <memory>
#include <string>
#include <string_view>

namespace relume {

// Evaluates the light of a light file, or a constant light, at a time.
class MovingLight {
  public:
    explicit MovingLight(Light still);

    // Parses the text of a light file (docs/light_format.md). `name` names it in errors; `folder` is where
    // the files that it names are. Throws Error if it is not JSON, or if a value is invalid at any time.
    MovingLight(std::string_view text, std::string name, std::filesystem::path folder);

    bool moves() const { return mMoves; }

    // Returns the light at a time ≥ 0, in seconds. Throws Error if a sequence's file cannot be read.
    Light at(double seconds);

    // Returns the files that the light file names.
    const std::set<std::filesystem::path>& files() const { return mFiles.named(); }

    // Lets at() also return the full-resolution pictures that backgrounds need.
    void keepPictures() { mFiles.keepPictures(); }

    // Sets a factor ≥ 0 on all light.
    void setGain(float gain) { mGain = gain; }

  private:
    struct Description; // the text's values

    Light read(const Description& values, double seconds);

    Light mStill; // without a description
    std::shared_ptr<const Description> mDescription;
    std::string mName;
    std::filesystem::path mFolder;
    EnvironmentFiles mFiles;
    bool mMoves = false;
    float mGain = 1;
};

} // namespace relume
