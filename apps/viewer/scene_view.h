// The view in the window; redraws what has changed since the last frame.
#pragma once

#include "apps/viewer/comparison.h"
#include "apps/viewer/content.h"
#include "apps/viewer/light_feed.h"
#include "apps/viewer/scene_state.h"
#include "engine/render/background_pass.h"
#include "engine/render/compare_pass.h"

namespace relume {

class SceneView {
  public:
    using Tell = std::function<void(const std::string& words, bool isFailure)>;
    // `wake` is called from other threads when there is something new to show.
    SceneView(const vk::Device& device, std::function<void()> wake, Tell tell);

    // Takes in results of other threads. Returns true if a frame must be drawn.
    bool poll();

    // Records the redrawing of what changed, at this size, and corrects impossible settings in `state`. A
    // view that differs from the last frame's is drawn as a draft with one sample per pixel, unless
    // `isFinal`.
    void record(vk::Commands& commands, SceneState& state, const std::shared_ptr<Model>& model, ivec2 size,
                bool isFinal);
    // Returns whether the last frame has fewer samples than wanted, so that another must be drawn.
    bool isDraft(const SceneState& state) const;
    // To be called after the recorded commands have finished. Returns true if it found a new exposure, so
    // that the frame must be recorded and shown again.
    bool submitted(SceneState& state);

    // Recreates the passes with the shaders that the device has now.
    void remakePrograms() {
        mComparePass.emplace(mDevice);
        mBackgroundPass.emplace(mDevice);
        mBackgroundInput.reset();
        mImage = nullptr;
    }

    // Returns the image to show, linear, in TRANSFER_SRC_OPTIMAL; null if there is none yet.
    const vk::Image* image() const;
    // Returns whether image() has false colors instead of radiance.
    bool isFalseColor(const SceneState& state) const;

    // Returns `state` as it was drawn: with the time of a light file at which it was evaluated.
    SceneState drawn(SceneState state) const;

    // Returns whether the newest light is shown.
    bool isSettled(const SceneState& state) const;
    // Versions count changes of the light and of the view. The view is still if the last frame changed
    // neither.
    uint64_t lightVersion() const { return mLightVersion; }
    uint64_t viewVersion() const { return mViewVersion; }
    bool isStill() const { return mIsStill; }

    const std::optional<LightStats>& lightStats() const { return mLightStats; }
    // Returns whether a reference is wanted: comparison is on, and radiance is shown.
    static bool compares(const SceneState& state);
    // Returns how the ground of the model shown is drawn.
    GroundStyle groundStyle(const SceneState& state) const;
    // Returns the result for the reference of the view; without passes if there is none.
    const Comparison::Result& compared() const { return mCompared; }

  private:
    struct Seen {
        Camera camera;
        ivec2 size{0};
        int terms = 0;
        bool addsResidual = true;
        int samples = 0;
        Inspect inspect = Inspect::Off;
        GroundStyle ground = GroundStyle::Whole;
    };
    // The model and light for which exposure was chosen.
    struct Exposed {
        std::weak_ptr<const Model> model;
        std::weak_ptr<const Environment> map;
        std::weak_ptr<const MovingLight> file;
    };
    void begin(const std::shared_ptr<Model>& model, SceneState& state);
    void bindChosen(SceneState& state);
    void recordLight(vk::Commands& commands, SceneState& state);
    void recordView(vk::Commands& commands, const SceneState& state, ivec2 size, bool isFinal);
    void recordCompared(vk::Commands& commands, const SceneState& state);
    void recordBackground(vk::Commands& commands, const SceneState& state);
    // Returns the fade that draws the model's ground in a style; none if it has no ground, or shows all of
    // it.
    std::optional<GroundFade> fadeOf(GroundStyle style) const;
    bool findExposure(SceneState& state);

    const vk::Device& mDevice;
    Tell mTell;
    LightFeed mFeed;
    Comparison mComparison;
    std::optional<ComparePass> mComparePass;
    std::optional<BackgroundPass> mBackgroundPass;
    Light mLight; // for which the tuples were computed, not rotated
    std::optional<std::pair<uint64_t, float>> mBackgroundInput; // light version and blur that the pass has
    std::optional<Exposed> mExposed;
    std::shared_ptr<Model> mModel;
    std::vector<WeightedMaterial> mBound;
    std::optional<LightState> mLit; // for which the tuples on the device were computed
    std::shared_ptr<const Light> mLitFile;
    std::optional<Seen> mSeen;
    std::optional<LightStats> mLightStats;
    uint64_t mLightVersion = 0, mViewVersion = 0;
    uint64_t mComparedVersion = 0; // view version of the comparison; 0: none is running
    bool mIsStill = false;
    vk::Image mReference;
    bool mReferenceIsNew = false; // still in SHADER_READ_ONLY_OPTIMAL
    Comparison::Result mCompared; // without its image
    const vk::Image* mImage = nullptr;
};

} // namespace relume
