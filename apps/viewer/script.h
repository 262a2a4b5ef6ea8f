// Replays a script of inputs and settings (docs/viewer.md).
#pragma once

#include "apps/viewer/window.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace relume {

// The viewer as a script controls it.
class ScriptTarget {
  public:
    virtual ~ScriptTarget() = default;
    virtual void input(InputEvent event) = 0;
    virtual void resize(int width, int height) = 0;
    virtual void screenshot(const std::filesystem::path& file) = 0;
    // Throws Error for an unknown setting.
    virtual void set(const std::string& name, const nlohmann::json& value) = 0;
    // Returns whether nothing is being read or baked and the newest result is shown.
    virtual bool isSettled() const = 0;
    // Returns whether a model is shown: a sketch, a preview or a bake.
    virtual bool isShown() const = 0;
    // Returns the number of passes of the reference shown. Throws Error if there will be none.
    virtual int comparedPasses() const = 0;
    virtual void quit() = 0;
};

class Script {
  public:
    // Throws Error naming file and step.
    explicit Script(const std::filesystem::path& file);

    // Runs the steps that are due; to be called before every frame.
    void step(ScriptTarget& target);
    bool hasEnded() const { return mStep >= mSteps.size(); }
    // Returns whether it waits for something other than frames.
    bool isWaiting() const { return !hasEnded() && mSteps[mStep].contains("wait"); }

  private:
    // Runs one step's inputs for this frame; returns true if the step has ended.
    bool run(ScriptTarget& target, const nlohmann::json& step);
    bool drag(ScriptTarget& target, const nlohmann::json& step);
    // Adds file and step to errors that `work` throws.
    template <typename Work>
    void tellStep(const Work& work);
    bool hasWaited(const ScriptTarget& target, const nlohmann::json& wait);

    std::filesystem::path mFile;
    nlohmann::json mSteps;
    size_t mStep = 0;
    int mFrame = 0; // of the current step
    std::chrono::steady_clock::time_point mWaitsSince;
};

} // namespace relume
