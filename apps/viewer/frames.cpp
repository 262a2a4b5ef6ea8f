#include "apps/viewer/frames.h"

#include "apps/viewer/overlay.h"
#include "engine/base/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <unistd.h>

namespace relume {

namespace {

// Returns the bytes of main memory in use (with software devices, including what is "on the device"), or 0 if
// the system does not tell.
uint64_t memoryInUse() {
    std::ifstream file("/proc/self/statm");
    uint64_t whole = 0, resident = 0;
    return file >> whole >> resident ? resident * uint64_t(sysconf(_SC_PAGESIZE)) : 0;
}

constexpr float kTurntableDegrees = 20; // a second
constexpr double kLongestStep = 0.25;   // seconds that a frame moves things by, however long it took

std::unique_ptr<Surface> makeSurface(const Window& window, const vk::Device& device) {
    return std::make_unique<Surface>(device.instance(), window.makeSurface(device.instance()));
}

void advance(SceneState& state, double seconds) {
    if (state.turns && state.orbit)
        state.orbit->azimuth =
            std::remainder(state.orbit->azimuth + glm::radians(kTurntableDegrees) * float(seconds), 2 * kPi);
    if (state.light.plays) play(state.light, seconds);
}

// Groups parts that have the same materials, so that a panel shows each choice once.
std::vector<PartMaterials> groupMaterials(const Asset& asset) {
    std::vector<PartMaterials> groups;
    for (size_t number = 0; number < asset.parts.size(); number++) {
        const AssetPart& part = asset.parts[number];
        PartMaterials group{.parts = {number}, .title = part.name, .sets = {}};
        for (const MaterialSet& set : part.sets) {
            auto& names = group.sets.emplace_back();
            for (const AssetMaterial& material : set.materials) names.push_back(material.name);
        }
        const auto same = std::ranges::find(groups, group.sets, &PartMaterials::sets);
        if (same == groups.end()) {
            groups.push_back(std::move(group));
            continue;
        }
        same->parts.push_back(number);
        same->title += ", " + part.name;
    }
    return groups;
}

} // namespace

Frames::Frames(Window& window, const vk::Device& device, const Shown& shown, bool waitsForDisplay)
    : mWindow(window), mDevice(device), mShown(shown), mSurface(makeSurface(window, device)),
      mSwapchain(device, mSurface->handle, waitsForDisplay), mUi(window, device, mSwapchain),
      mDisplay(std::make_unique<DisplayPass>(device, mSwapchain.format())), mCommands(device, "frame"),
      mOutputs(
          device, mCommands,
          [this](const std::string& words, bool isFailure) { mShown.notice.tell(words, isFailure); },
          Window::wake),
      mPictures(mUi.pictures(), Window::wake) {}

void Frames::remakePrograms() { mDisplay = std::make_unique<DisplayPass>(mDevice, mSwapchain.format()); }

// Returns false where there is nothing to draw on.
bool Frames::prepareSwapchain() {
    const ivec2 size = mWindow.size();
    if (size != ivec2(int(mSwapchain.width()), int(mSwapchain.height()))) mNeedsSwapchain = true;
    if (mSwapchain.hasLostSurface()) {
        std::unique_ptr<Surface> surface = makeSurface(mWindow, mDevice);
        mSwapchain.setSurface(surface->handle);
        mSurface = std::move(surface);
        mNeedsSwapchain = true;
    }
    if (mSwapchain.setWaitsForDisplay(mShown.state.waitsForDisplay)) mNeedsSwapchain = true;
    if (!mNeedsSwapchain) return true;
    if (!mSwapchain.resize(uint32_t(size.x), uint32_t(size.y))) {
        mWindow.poll(0.1); // minimized
        return false;
    }
    mUi.resized();
    mNeedsSwapchain = false;
    return true;
}

std::optional<PanelRequests> Frames::draw(double seconds, bool mustWrite) {
    const Stopwatch watch;
    if (!prepareSwapchain()) return std::nullopt;
    const vk::FrameSpan frame(mOutputs.capture());
    const std::optional<uint32_t> image = mSwapchain.acquire();
    if (!image) {
        mNeedsSwapchain = true;
        return std::nullopt;
    }
    SceneState& state = mShown.state;
    advance(state, mOutputs.isRecording() ? 1 / Recorder::kFramesPerSecond : std::min(seconds, kLongestStep));
    const PanelRequests requests = drawUi();

    const vk::Image& target = mSwapchain.images()[*image];
    mCommands.clearTimes();
    mCommands.setTimed(requests.showsTimes || mOutputs.isCapturing());
    bool isRead = submit(target, *image);
    // A new light is never shown with the exposure of the last one.
    if (mShown.view.submitted(state)) isRead = submit(target, *image);
    if (mShown.view.image()) mPictures.update(state, mShown.content.shown(), mShown.view);
    if (isRead) save(mustWrite);
    if (!mSwapchain.present(*image)) mNeedsSwapchain = true;
    mTimes.add(watch.seconds(), mCommands.times());
    mWanted = std::max(0, mWanted - 1);
    // One frame draws all samples; a second one notices that the view is still.
    if (!state.turns && !state.light.plays && mShown.view.isDraft(state)) want(2);
    return requests;
}

// Returns whether the window's image is to be read. Recordings have no panels.
bool Frames::submit(const vk::Image& target, uint32_t image) {
    mCommands.begin();
    mUi.pictures().record(mCommands);
    recordView(target);
    const bool isRecorded = mOutputs.isRecording() && mOutputs.record(target);
    if (isRecorded)
        mCommands.transition(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, vk::Stage::Transfer, vk::Stage::Color);
    mUi.record(mCommands, image);
    const bool isRead = !isRecorded && mOutputs.record(target);
    mCommands.transition(
        target, isRead ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, isRead ? vk::Stage::Transfer : vk::Stage::Color, vk::Stage::Host);
    mCommands.submitAndWait();
    return isRead || isRecorded;
}

void Frames::recordView(const vk::Image& target) {
    SceneState& state = mShown.state;
    const vec3 background = state.isDark ? vec3(0.11f, 0.12f, 0.14f) : vec3(0.75f, 0.77f, 0.8f);
    const ivec2 size(int(mSwapchain.width()), int(mSwapchain.height()));
    SceneView& view = mShown.view;
    if (mShown.content.shown())
        view.record(mCommands, state, mShown.content.shown(), size, mOutputs.wantsFrame());
    if (const vk::Image* const image = view.image()) {
        const bool isFalse = view.isFalseColor(state);
        mDisplay->record(mCommands, *image, target,
                         {isFalse ? ToneCurve::None : state.tone, isFalse ? 0 : state.exposure, background});
        return;
    }
    mCommands.transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                         vk::Stage::Color, vk::Stage::Color);
    mCommands.render({.color = &target, .clear = {background.x, background.y, background.z, 1}}, [] {});
}

PanelRequests Frames::drawUi() {
    SceneState& state = mShown.state;
    mUi.setDark(state.isDark);
    mUi.begin();
    const PanelFacts known = facts();
    const Model* const model = mShown.content.shown().get();
    if (model && state.orbit && state.showsPanels) {
        mShown.lamps.draw(state.light, state.orbit->camera(), model->bounds, mWindow.size());
        drawOverlay(state, known, state.orbit->camera(), mWindow.size());
    }
    const PanelRequests requests = drawPanels(state, known);
    mUi.end();
    return requests;
}

PanelFacts Frames::facts() const {
    PanelFacts facts;
    facts.content = &mShown.content;
    facts.times = &mTimes;
    facts.pictures = &mUi.pictures();
    facts.device = mDevice.name();
    facts.memory = memoryInUse();
    facts.isCapturing = mOutputs.isCapturing();
    facts.isRecording = mOutputs.isRecording();
    facts.notice = mShown.notice.words();
    facts.isFailure = mShown.notice.isFailure();
    facts.light = mShown.view.lightStats();
    facts.passes = mShown.view.compared().passes;
    facts.error = mShown.view.compared().error;
    mPictures.describe(facts);
    if (mShown.content.shown()) facts.materials = groupMaterials(mShown.content.shown()->asset);
    return facts;
}

void Frames::save(bool mustWrite) {
    const SceneView& view = mShown.view;
    const auto write = [&] {
        mOutputs.save(view.drawn(mShown.state), view.image() ? mShown.content.shown().get() : nullptr,
                      view.groundStyle(mShown.state));
    };
    mustWrite ? write() : attempt(mShown.notice, write);
}

} // namespace relume
