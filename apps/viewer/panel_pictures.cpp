#include "apps/viewer/panel_pictures.h"

#include "apps/viewer/cube_images.h"
#include "apps/viewer/swatch.h"
#include "engine/light/day_sky.h"

#include <algorithm>

namespace relume {

namespace {

constexpr int kThumbnailWidth = 128, kSwatchSide = 64;
constexpr auto kBetweenLights = std::chrono::milliseconds(250); // between updates while the light moves

Image thumbnailOf(const EnvironmentChoice& choice, const DaySkyChoice& day) {
    constexpr int kHeight = kThumbnailWidth / 2;
    if (choice.kind != EnvironmentChoice::Kind::DaySky)
        return thumbnailOf(*choice.map, kThumbnailWidth, kHeight);
    const SunPlace sun = sunPlaceOf(day);
    Light light;
    light.sky = DaySky{.sun = directionAt(sun.azimuth, sun.elevation)};
    return latlongOf(sampleLight(light, 32), kThumbnailWidth);
}

Image crossPicture(const LightCube& cube, const SceneState& state) {
    return toneMap(crossOf(cube, kCrossSide / cube.size), state.tone, state.exposure);
}

} // namespace

PanelPictures::PanelPictures(Pictures& pictures, std::function<void()> wake)
    : mPictures(pictures), mWorker(std::move(wake)) {
    mLightMap = mPictures.add(kMapWidth, kMapWidth / 2);
    mContributions = mPictures.add(kMapWidth, kMapWidth / 2);
    for (Picture* cross : {&mLightGiven, &mLightKept, &mVisibility, &mTransport})
        *cross = mPictures.add(4 * kCrossSide, 3 * kCrossSide);
}

bool PanelPictures::poll() {
    mWorker.apply();
    return std::exchange(mHasNews, false);
}

void PanelPictures::update(const SceneState& state, const std::shared_ptr<Model>& model,
                           const SceneView& view) {
    updateThumbnails(state);
    updateSwatches(model);
    updateLight(state, *model, view);
    updateExplanation(state, model, view);
}

void PanelPictures::updateThumbnails(const SceneState& state) {
    mEnvironments.resize(state.light.environments.size());
    for (size_t i = 0; i < mEnvironments.size(); i++) {
        const EnvironmentChoice& choice = state.light.environments[i];
        if (mEnvironments[i] || (!choice.map && choice.kind != EnvironmentChoice::Kind::DaySky)) continue;
        mEnvironments[i] = mPictures.add(kThumbnailWidth, kThumbnailWidth / 2);
        mPictures.set(*mEnvironments[i], toneMap(thumbnailOf(choice, state.light.sky), ToneCurve::Agx, 0));
        mHasNews = true;
    }
}

void PanelPictures::updateSwatches(const std::shared_ptr<Model>& model) {
    if (mDescribed.lock() == model) return;
    mDescribed = model;
    mDescriptions.clear();
    for (const AssetPart& part : model->asset.parts)
        for (const MaterialSet& set : part.sets)
            for (const AssetMaterial& material : set.materials) {
                mDescriptions.emplace(material.name, material.description);
                if (!mSwatches.try_emplace(material.description).second) continue;
                mWorker.post(
                    "painting " + material.name,
                    [this, description = material.description]() -> Worker::Result {
                        const Image swatch =
                            toneMap(renderSwatch(description, kSwatchSide), ToneCurve::Agx, 0);
                        return [this, description, swatch] {
                            Picture& picture = mSwatches[description];
                            picture = mPictures.add(kSwatchSide, kSwatchSide);
                            mPictures.set(picture, swatch);
                            mHasNews = true;
                        };
                    },
                    [](const std::string&) {}); // measured data may be missing; the name suffices then
            }
}

void PanelPictures::updateLight(const SceneState& state, const Model& model, const SceneView& view) {
    if (!state.showsPanels || !(state.opensLight || state.showsLight)) return;
    const auto now = std::chrono::steady_clock::now();
    const ShownLight wanted{view.lightVersion(), state.showsLight, state.tone, state.exposure};
    if (mShownLight == wanted || (!view.isStill() && now - mLightTime < kBetweenLights)) return;
    mShownLight = wanted;
    mLightTime = now;
    const LightCube given = model.light.readCube();
    mPictures.set(mLightMap, toneMap(latlongOf(given, kMapWidth), state.tone, state.exposure));
    if (state.showsLight) {
        mPictures.set(mLightGiven, crossPicture(given, state));
        mPictures.set(mLightKept, crossPicture(reconstruct(model.light.readVector()), state));
    }
    mHasNews = true;
}

void PanelPictures::stopAsking() {
    mAsked.reset();
    mExplanation.reset();
}

void PanelPictures::updateExplanation(const SceneState& state, const std::shared_ptr<Model>& model,
                                      const SceneView& view) {
    if (!mAsked || mAsked->version == view.viewVersion() || !view.isStill()) return;
    const Asset& asset = model->asset;
    if (mAsked->model != model->file || mAsked->part >= asset.parts.size() ||
        mAsked->vertex >= asset.parts[mAsked->part].mesh.vertexCount())
        return stopAsking(); // it was of another model
    mAsked->version = view.viewVersion();
    mWorker.post(
        "asking why",
        [this, question = VertexQuestion{model, model->appearance[mAsked->part], mAsked->part, mAsked->vertex,
                                         state.orbit->camera().eye, model->light.readCube(),
                                         model->light.readVector()}]() -> Worker::Result {
            auto explanation = std::make_shared<VertexExplanation>(explainVertex(question));
            return [this, explanation] {
                if (!mAsked) return;
                mPictures.set(mVisibility, explanation->visibility);
                mPictures.set(mTransport, explanation->transport);
                mPictures.set(mContributions, explanation->contributions);
                mExplanation = std::move(*explanation);
                mHasNews = true;
            };
        },
        [](const std::string&) {});
}

void PanelPictures::describe(PanelFacts& facts) const {
    for (const std::optional<Picture>& picture : mEnvironments)
        facts.environments.push_back(picture.value_or(Picture{}));
    for (const auto& [name, description] : mDescriptions) {
        const auto swatch = mSwatches.find(description);
        if (swatch != mSwatches.end() && swatch->second) facts.swatches[name] = swatch->second;
    }
    if (mShownLight.version > 0) facts.lightMap = mLightMap;
    facts.lightGiven = mLightGiven;
    facts.lightKept = mLightKept;
    facts.visibility = mVisibility;
    facts.transport = mTransport;
    facts.contributions = mContributions;
    facts.explanation = mExplanation ? &*mExplanation : nullptr;
}

} // namespace relume
