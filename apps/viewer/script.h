// A session that was written down: inputs and settings, one after the other. Format: docs/viewer.md.
#pragma once

#include "apps/viewer/window.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace relume {

// What a script asks of its viewer.
class ScriptTarget {
  public:
    virtual ~ScriptTarget() = default;
    virtual void input(InputEvent event) = 0;
    virtual void resize(int width, int height) = 0;
    virtual void screenshot(const std::filesystem::path& file) = 0;
    // Throws Error for a setting that there is not.
    virtual void set(const std::string& name, const nlohmann::json& value) = 0;
    // Nothing is being read or baked, and the newest of it is shown.
    virtual bool isSettled() const = 0;
    // A model is shown: a sketch, a preview or a bake.
    virtual bool isShown() const = 0;
    // Of the reference that is shown. Throws Error when there will be none.
    virtual int comparedPasses() const = 0;
    virtual void quit() = 0;
};

class Script {
  public:
    // Throws Error that names file and step.
    explicit Script(const std::filesystem::path& file);

    // Before every frame: does what is due.
    void step(ScriptTarget& target);
    bool hasEnded() const { return mStep >= mSteps.size(); }
    // For something else than frames.
    bool isWaiting() const { return !hasEnded() && mSteps[mStep].contains("wait"); }

  private:
    // One step's inputs of this frame; true: it has ended.
    bool run(ScriptTarget& target, const nlohmann::json& step);
    bool drag(ScriptTarget& target, const nlohmann::json& step);
    // Names file and step in what `work` throws.
    template <typename Work>
    void tellStep(const Work& work);
    bool hasWaited(const ScriptTarget& target, const nlohmann::json& wait);

    std::filesystem::path mFile;
    nlohmann::json mSteps;
    size_t mStep = 0;
    int mFrame = 0; // of the step
    std::chrono::steady_clock::time_point mWaitsSince;
};

} // namespace relume
