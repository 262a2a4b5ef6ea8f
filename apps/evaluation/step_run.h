// What a step of the evaluation may use while it runs.
#pragma once

#include "apps/evaluation/baked_scene.h"
#include "apps/evaluation/step_store.h"
#include "engine/image/image.h"
#include "engine/vk/device.h"

namespace relume {

class StepRun {
  public:
    StepRun(const vk::Device& device, const BakeStore& bakes, std::filesystem::path folder, std::string step);

    const vk::Device& device;

    // A bake that the step has listed; timed: which found its visibility itself (msPerVertex).
    BakeRecord bake(const BakeRecipe& recipe) const { return mBakes.make(recipe); }
    BakeRecord timedBake(const BakeRecipe& recipe) const { return mBakes.makeTimed(recipe); }
    Asset asset(const BakeRecipe& recipe) const;
    // Of a step that this one comes after: linear, as it was written.
    Image image(const std::string& step, const std::string& name) const;

    // Writes images/STEP/NAME.exr; .png, tone-mapped (ACES) at this exposure in stops; both.
    void writeLinear(const std::string& name, const Image& linear);
    void writeToned(const std::string& name, const Image& linear, float exposure);
    void write(const std::string& name, const Image& linear, float exposure);
    // Display values, as images/STEP/NAME.png.
    void writeDisplay(const std::string& name, const Image& display);

    const std::vector<std::string>& files() const { return mFiles; }

  private:
    std::string place(const std::string& file); // from the evaluation's folder

    const BakeStore& mBakes;
    std::filesystem::path mFolder;
    std::string mStep;
    std::vector<std::string> mFiles;
};

// Where a picture of a step lies, from the report's folder.
std::filesystem::path pictureOf(const std::string& step, const std::string& name);

} // namespace relume
