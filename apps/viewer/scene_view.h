// The view that the window shows: draws of it what has changed since the last frame.
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
    // `wake` is called from other threads when there is something new to be shown.
    SceneView(const vk::Device& device, std::function<void()> wake, Tell tell);

    // Takes in what other threads have found. True: a frame is to be drawn.
    bool poll();

    // Records whatever of the model must be redrawn at this size, and corrects impossible settings in
    // `state`. A view that differs from the last frame's is drawn as a draft of one sample a pixel, unless
    // `isFinal`.
    void record(vk::Commands& commands, SceneState& state, const std::shared_ptr<Model>& model, ivec2 size,
                bool isFinal);
    // The last frame has fewer samples than are wanted, so that another one must be drawn.
    bool isDraft(const SceneState& state) const;
    // Call it after the recorded commands have finished. Returns true if it found a new exposure, so that the
    // frame must be recorded and shown again.
    bool submitted(SceneState& state);

    // With the shaders that the device has now.
    void remakePrograms() {
        mComparePass.emplace(mDevice);
        mBackgroundPass.emplace(mDevice);
        mBehind.reset();
        mImage = nullptr;
    }

    // Linear, in TRANSFER_SRC_OPTIMAL; null: nothing is there yet.
    const vk::Image* image() const;
    // Image() is not radiance, but has colors of its own.
    bool isFalseColor(const SceneState& state) const;

    // The state as it is drawn: of a light file that plays, the moment.
    SceneState drawn(SceneState state) const;

    // The newest light is shown.
    bool isSettled(const SceneState& state) const;
    // They count changes of the light and of what is seen. The view is still: the last frame changed neither.
    uint64_t lightVersion() const { return mLightVersion; }
    uint64_t viewVersion() const { return mViewVersion; }
    bool isStill() const { return mIsStill; }

    const std::optional<LightStats>& lightStats() const { return mLightStats; }
    // A reference is wanted: comparing is on, and what is seen is radiance.
    static bool compares(const SceneState& state);
    // The ground of the model that is shown ends before its edge.
    bool fadesGround(const SceneState& state) const;
    // Of the reference of what is seen; no passes: none is there.
    const Comparison::Result& compared() const { return mCompared; }

  private:
    struct Seen {
        Camera camera;
        ivec2 size{0};
        int terms = 0;
        bool addsResidual = true;
        int samples = 0;
        Inspect inspect = Inspect::Off;
        bool fadesGround = false;
    };
    // The model and light that the automatic exposure belongs to.
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
    bool findExposure(SceneState& state);

    const vk::Device& mDevice;
    Tell mTell;
    LightFeed mFeed;
    Comparison mComparison;
    std::optional<ComparePass> mComparePass;
    std::optional<BackgroundPass> mBackgroundPass;
    Light mLight;                                      // what the tuples were made for, not turned
    std::optional<std::pair<uint64_t, float>> mBehind; // light version and blur that the pass has
    std::optional<Exposed> mExposed;
    std::shared_ptr<Model> mModel;
    std::vector<WeightedMaterial> mBound;
    std::optional<LightState> mLit; // what the tuples on the device were made for
    std::shared_ptr<const Light> mLitFile;
    std::optional<Seen> mSeen;
    std::optional<LightStats> mLightStats;
    uint64_t mLightVersion = 0, mViewVersion = 0;
    uint64_t mComparedVersion = 0; // that the comparison is of; 0: none is under way
    bool mIsStill = false;
    vk::Image mReference;
    bool mReferenceIsNew = false; // still in SHADER_READ_ONLY_OPTIMAL
    Comparison::Result mCompared; // without its image
    const vk::Image* mImage = nullptr;
};

} // namespace relume
