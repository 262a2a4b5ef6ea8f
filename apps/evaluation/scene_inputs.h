// The meshes and environments that the paper's scenes need: those that are there, and what was looked for
// where they are not.
#pragma once

#include "engine/import/scene.h"

#include <map>
#include <span>

namespace relume {

struct SceneInput {
    std::string name; // as the report calls it: "Buddha", "Grace Cathedral"
    std::filesystem::path file;
    UpAxis up = UpAxis::Y;
    std::string hash;      // of the file's content
    std::string standsFor; // what it takes the place of; mostly empty
};

// "bunny", or "bunny, standing for Buddha".
std::string describe(const SceneInput& input);

class SceneInputs {
  public:
    // `data` may be empty: then there is what Debian's packages install. `standIns`: what is missing is
    // replaced by what is installed, and says so.
    SceneInputs(std::filesystem::path data, bool standIns) : mData(std::move(data)), mStandIns(standIns) {}

    // "bunny", "buddha", "dragon" or "lucy". None: neither it nor a stand-in is there.
    std::optional<SceneInput> model(const std::string& name);
    // "grace", "stpeters", "rnl" (Eucalyptus Grove) or "uffizi". None as above.
    std::optional<SceneInput> environment(const std::string& name);
    // One that is installed, for scenes in which any will do.
    std::optional<SceneInput> anyEnvironment();

    // What was asked for and is not there: a line each, in order, none twice.
    const std::vector<std::string>& missing() const { return mMissing; }

  private:
    std::optional<SceneInput> find(const std::string& title,
                                   const std::vector<std::filesystem::path>& places);
    // The first file of a folder of the data, by name, that begins so and has one of these extensions.
    std::filesystem::path inData(const char* folder, const std::string& name,
                                 std::span<const std::string_view> extensions) const;
    void miss(const std::string& title, const std::string& lookedFor, const std::string& instead);

    std::filesystem::path mData;
    bool mStandIns;
    std::vector<std::string> mMissing;
    std::map<std::filesystem::path, std::string> mHashes;
};

} // namespace relume
