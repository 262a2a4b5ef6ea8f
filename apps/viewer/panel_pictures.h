// The pictures of panels, kept as what they show changes.
#pragma once

#include "apps/viewer/panels.h"
#include "apps/viewer/scene_view.h"

#include <chrono>

namespace relume {

class PanelPictures {
  public:
    // `wake` as Worker's.
    PanelPictures(Pictures& pictures, std::function<void()> wake);

    // Takes in what was painted beside the frames. True: a frame is to be drawn.
    bool poll();

    // After a frame, of a view that is there: what panels show of its light, if it is still or some time has
    // passed, and thumbnails and swatches of what has come.
    void update(const SceneState& state, const std::shared_ptr<Model>& model, const SceneView& view);

    // Asks why this vertex of the model has its color; the answer follows light, eye and material.
    void ask(const Model& model, size_t part, uint32_t vertex) {
        mAsked = Asked{model.file, part, vertex, 0};
    }
    void stopAsking();

    // Their places, and the answer.
    void describe(PanelFacts& facts) const;
    bool isSettled() const { return mWorker.isIdle(); }

  private:
    struct Asked {
        std::filesystem::path model;
        size_t part = 0;
        uint32_t vertex = 0;
        uint64_t version = 0; // of the view that was asked about
    };
    // What the light's pictures are of.
    struct ShownLight {
        uint64_t version = 0;
        bool showsVector = false;
        ToneCurve tone = ToneCurve::Agx;
        float exposure = 0;
        bool operator==(const ShownLight&) const = default;
    };
    void updateThumbnails(const SceneState& state);
    void updateSwatches(const std::shared_ptr<Model>& model);
    void updateLight(const SceneState& state, const Model& model, const SceneView& view);
    void updateWhy(const SceneState& state, const std::shared_ptr<Model>& model, const SceneView& view);

    Pictures& mPictures;
    std::vector<std::optional<Picture>> mEnvironments; // none: not tried yet
    std::map<std::string, Picture> mSwatches;          // by description
    std::map<std::string, std::string> mDescriptions;  // of the model's materials, by name
    std::weak_ptr<const Model> mDescribed;
    Picture mLightMap, mLightGiven, mLightKept, mVisibility, mTransport, mContributions;
    ShownLight mShownLight;
    std::chrono::steady_clock::time_point mLightTime;
    std::optional<Asked> mAsked;
    std::optional<Why> mWhy;
    bool mHasNews = false;
    Worker mWorker; // last: its work uses all of the above
};

} // namespace relume
