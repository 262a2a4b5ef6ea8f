#include "apps/viewer/scene_view.h"

#include "engine/base/error.h"
#include "engine/render/tone_map.h"
#include "engine/vk/upload.h"

#include <algorithm>
#include <utility>

namespace relume {

namespace {

// Difference that the hottest color shows, where 1 is displayed as white.
constexpr float kHottest = 0.25f;

} // namespace

SceneView::SceneView(const vk::Device& device, std::function<void()> wake, Tell tell)
    : mDevice(device), mTell(std::move(tell)),
      mFeed(wake, [this](const std::string& why) { mTell(why, true); }), mComparison(wake),
      mComparePass(std::in_place, device), mBackgroundPass(std::in_place, device) {}

bool SceneView::poll() {
    bool hasNews = mFeed.poll();
    std::optional<Comparison::Result> result = mComparison.take();
    if (result && !result->failure.empty()) {
        mCompared = {.failure = result->failure};
        mTell(result->failure, true);
    }
    if (result && result->failure.empty()) {
        const Image& image = result->reference;
        mReference = vk::uploadImage(mDevice,
                                     {.width = uint32_t(image.width),
                                      .height = uint32_t(image.height),
                                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                               VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                                     std::as_bytes(std::span(image.pixels)), "reference");
        mReferenceIsNew = true;
        mCompared = {result->passes, {}, result->error, ""};
        hasNews = true;
    }
    return hasNews;
}

void SceneView::record(vk::Commands& commands, SceneState& state, const std::shared_ptr<Model>& model,
                       ivec2 size, bool isFinal) {
    if (model != mModel) begin(model, state);
    state.keepsOrbit = false;
    if (!state.orbit)
        state.orbit =
            defaultOrbit(mModel->bounds, glm::radians(state.fovDegrees), float(size.x) / float(size.y));
    const uint64_t light = mLightVersion, view = mViewVersion;
    bindChosen(state);
    recordLight(commands, state);
    mImage = nullptr;
    if (!mLit) return;
    recordView(commands, state, size, isFinal);
    mIsStill = light == mLightVersion && view == mViewVersion;
    mImage = &mModel->view.image();
    recordCompared(commands, state);
    recordBackground(commands, state);
}

void SceneView::begin(const std::shared_ptr<Model>& model, SceneState& state) {
    // Keep the camera for the same object; show all of another one.
    const float slack = 1e-3f * model->bounds.radius();
    const bool isSame = mModel && glm::distance(mModel->bounds.low, model->bounds.low) < slack &&
                        glm::distance(mModel->bounds.high, model->bounds.high) < slack;
    if (mModel && !isSame && !state.keepsOrbit) state.orbit.reset();
    if (!isSame) state.picked.reset();
    mModel = model;
    mLit.reset();
    mSeen.reset();
    mLightStats.reset();
    mBound.clear();
    mImage = nullptr;
    mModel->appearance = defaultAppearance(mModel->asset);
    mModel->view.setAppearance(mModel->appearance);
    const std::vector<std::string> names = materialNames(mModel->asset);
    std::erase_if(state.material, [&](const WeightedMaterial& material) {
        return std::ranges::find(names, material.name) == names.end();
    });
}

void SceneView::bindChosen(SceneState& state) {
    if (mBound == state.material) return;
    Appearance appearance = defaultAppearance(mModel->asset);
    try {
        bindMaterials(appearance, mModel->asset, state.material);
    } catch (const Error& why) {
        mTell(why.what(), true);
        state.material = mBound;
        return;
    }
    mBound = state.material;
    // Another set's tuples are of an earlier light.
    const bool isRelit =
        !std::ranges::equal(appearance, mModel->appearance, {}, &PartAppearance::set, &PartAppearance::set);
    mModel->appearance = std::move(appearance);
    mModel->view.setAppearance(mModel->appearance);
    if (isRelit) mLit.reset();
    mSeen.reset();
}

void SceneView::recordLight(vk::Commands& commands, SceneState& state) {
    LightState& light = state.light;
    if (light.file) mFeed.want(light.file, light.seconds);
    if (light.file && !mFeed.light() && mFeed.isNewest()) light.file.reset(); // it cannot be read
    const std::shared_ptr<const Light> fromFile = light.file ? mFeed.light() : nullptr;
    // Keep the previous light until the chosen one is ready.
    if (light.file ? !fromFile : !light.isReady()) return;
    if (mLit && mLitFile == fromFile && lightsAlike(*mLit, light)) return;
    mLight = fromFile ? *fromFile : lightOf(light);
    mModel->light.setLight(mLight);
    mModel->light.record(commands, glm::radians(light.rotation), light.selection);
    mModel->relighter.record(commands, mModel->light, mModel->appearance);
    mLit = light;
    mLitFile = fromFile;
    mSeen.reset();
    mLightStats.reset();
    mLightVersion++;
}

void SceneView::recordView(vk::Commands& commands, const SceneState& state, ivec2 size, bool isFinal) {
    Seen now{state.orbit->camera(), size,          state.terms,       state.addsResidual,
             state.samples,         state.inspect, groundStyle(state)};
    const bool isSame = mSeen && mSeen->camera.eye == now.camera.eye &&
                        mSeen->camera.target == now.camera.target &&
                        mSeen->camera.verticalFov == now.camera.verticalFov && mSeen->size == size &&
                        mSeen->terms == now.terms && mSeen->addsResidual == now.addsResidual &&
                        mSeen->inspect == now.inspect && mSeen->ground == now.ground;
    if (isSame && mSeen->samples == now.samples) return;
    // Edges may be jagged while things move; a still view is drawn again with all samples.
    if (!isSame && !isFinal) now.samples = 1;
    const vk::ImageOptions& options = mModel->view.image().options();
    if (ivec2(int(options.width), int(options.height)) != size) mModel->view.resize(size.x, size.y);
    mModel->view.setSamples(now.samples);
    mModel->view.setTerms(now.terms);
    mModel->view.setResidual(now.addsResidual || mModel->isSketch);
    mModel->view.setInspect(now.inspect);
    mModel->view.setGroundFade(fadeOf(now.ground));
    mModel->view.record(commands, now.camera, mModel->relighter);
    mSeen = now;
    mViewVersion++;
}

bool SceneView::compares(const SceneState& state) {
    return state.compare != Compare::Off && state.inspect == Inspect::Off;
}

void SceneView::recordCompared(vk::Commands& commands, const SceneState& state) {
    if (!compares(state) || mComparedVersion != mViewVersion) {
        if (mComparedVersion != 0) mComparison.stop();
        mComparedVersion = 0;
        mCompared = {};
        return;
    }
    if (mCompared.passes == 0) return;
    if (mReferenceIsNew)
        commands.transition(mReference, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Transfer, vk::Stage::Draw);
    mReferenceIsNew = false;
    mImage = &mReference;
    if (state.compare == Compare::Reference) return;
    const CompareMode mode = state.compare == Compare::Split ? CompareMode::Split : CompareMode::Difference;
    mComparePass->record(commands, mModel->view.image(), mReference,
                         {mode, state.split, std::exp2(state.exposure) / kHottest});
    mImage = &mComparePass->image();
}

GroundStyle SceneView::groundStyle(const SceneState& state) const {
    // A map of the difference is of all that is baked, the ground included.
    const bool isMap = compares(state) && state.compare == Compare::Difference;
    const bool isStyled = mModel && mModel->groundFade && state.background != BackgroundKind::None &&
                          state.inspect == Inspect::Off && !isMap;
    return isStyled ? state.ground : GroundStyle::Whole;
}

std::optional<GroundFade> SceneView::fadeOf(GroundStyle style) const {
    if (style == GroundStyle::Whole) return std::nullopt;
    std::optional<GroundFade> fade = mModel->groundFade;
    if (fade) fade->isShadow = style == GroundStyle::Shadow;
    return fade;
}

void SceneView::recordBackground(vk::Commands& commands, const SceneState& state) {
    if (state.background == BackgroundKind::None || isFalseColor(state)) return;
    if (!mBackgroundInput || mBackgroundInput->first != mLightVersion ||
        mBackgroundInput->second != state.backgroundBlur) {
        mBackgroundPass->setLight(mLight, glm::radians(state.backgroundBlur));
        mBackgroundInput.emplace(mLightVersion, state.backgroundBlur);
    }
    mBackgroundPass->record(commands, *mImage, mSeen->camera, glm::radians(mLit->rotation));
    mImage = &mBackgroundPass->image();
}

bool SceneView::submitted(SceneState& state) {
    if (!mModel || !mLit) return false;
    if (!mLightStats) mLightStats = mModel->light.readStats();
    if (mIsStill && compares(state) && mComparedVersion != mViewVersion) {
        mComparison.begin({mModel, mSeen->camera, mModel->light.readCube(), mModel->appearance,
                           mModel->view.read(), mModel->view.samples(), fadeOf(mSeen->ground)});
        mComparedVersion = mViewVersion;
    }
    return findExposure(state);
}

bool SceneView::findExposure(SceneState& state) {
    if (!state.exposesItself || state.inspect != Inspect::Off) return false;
    const std::shared_ptr<const Environment> map = mLit->file ? nullptr : mLit->chosen().map;
    const bool isNew = !mExposed || mExposed->model.lock() != mModel || mExposed->map.lock() != map ||
                       mExposed->file.lock() != mLit->file;
    if (!isNew && !state.wantsExposure) return false;
    state.wantsExposure = false;
    mExposed = Exposed{mModel, map, mLit->file};
    const float before = std::exchange(state.exposure, autoExposure(mModel->view.read()));
    return state.exposure != before;
}

const vk::Image* SceneView::image() const { return mImage; }

bool SceneView::isFalseColor(const SceneState& state) const {
    return state.inspect != Inspect::Off ||
           (state.compare == Compare::Difference && mImage == &mComparePass->image());
}

SceneState SceneView::drawn(SceneState state) const {
    if (state.light.file) state.light.seconds = mFeed.seconds();
    return state;
}

bool SceneView::isDraft(const SceneState& state) const { return mSeen && mSeen->samples != state.samples; }

bool SceneView::isSettled(const SceneState& state) const {
    return mLit && (state.light.file ? mFeed.isNewest() : state.light.isReady());
}

} // namespace relume
