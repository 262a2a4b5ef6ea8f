// The pictures in panels, updated when what they show changes.
#pragma once

#include "apps/viewer/panels.h"
#include "apps/viewer/scene_view.h"

#include <chrono>

namespace relume {

class PanelPictures {
  public:
    // Keeps a reference to `pictures`. `wake` is as for Worker.
    PanelPictures(Pictures& pictures, std::function<void()> wake);

    // Takes in pictures made in the background. Returns true if a frame must be drawn.
    bool poll();

    // Updates pictures after a frame: those of the light if it is still or some time has passed, and new
    // thumbnails and swatches.
    void update(const SceneState& state, const std::shared_ptr<Model>& model, const SceneView& view);

    // Explains the color of this vertex of the model; the answer is updated with light, eye and material.
    void ask(const Model& model, size_t part, uint32_t vertex) {
        mAsked = Asked{model.file, part, vertex, 0};
    }
    void stopAsking();

    // Fills in the places of all pictures, and the answer.
    void describe(PanelFacts& facts) const;
    bool isSettled() const { return mWorker.isIdle(); }

  private:
    struct Asked {
        std::filesystem::path model;
        size_t part = 0;
        uint32_t vertex = 0;
        uint64_t version = 0; // of the view for which it was answered
    };
    // The state for which the pictures of the light were made.
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
    void updateExplanation(const SceneState& state, const std::shared_ptr<Model>& model,
                           const SceneView& view);

    Pictures& mPictures;
    std::vector<std::optional<Picture>> mEnvironments; // none: not made yet
    std::map<std::string, Picture> mSwatches;          // by description
    std::map<std::string, std::string> mDescriptions;  // by name: descriptions of the model's materials
    std::weak_ptr<const Model> mDescribed;
    Picture mLightMap, mLightGiven, mLightKept, mVisibility, mTransport, mContributions;
    ShownLight mShownLight;
    std::chrono::steady_clock::time_point mLightTime;
    std::optional<Asked> mAsked;
    std::optional<VertexExplanation> mExplanation;
    bool mHasNews = false;
    Worker mWorker; // last: its work uses all of the above
};

} // namespace relume
