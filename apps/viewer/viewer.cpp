#include "apps/viewer/viewer.h"

#include "apps/viewer/controls.h"
#include "apps/viewer/habits.h"
#include "apps/viewer/lamp_handles.h"
#include "apps/viewer/memory_use.h"
#include "apps/viewer/opened_file.h"
#include "apps/viewer/outputs.h"
#include "apps/viewer/overlay.h"
#include "apps/viewer/panel_pictures.h"
#include "apps/viewer/script.h"
#include "apps/viewer/session.h"
#include "apps/viewer/settings.h"
#include "apps/viewer/shader_compiler.h"
#include "apps/viewer/surface.h"
#include "apps/viewer/ui.h"
#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/render/display_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

using Clock = std::chrono::steady_clock;

constexpr float kTurntableDegrees = 20; // a second
constexpr int kFramesAfterInput = 3;    // until panels have taken it in
constexpr double kNoticeSeconds = 8;    // that good news are shown

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

vk::DeviceOptions deviceOptions(const ViewerOptions& options, const Window& window) {
    vk::DeviceOptions device = options.device;
    device.surfaceExtensions = window.surfaceExtensions();
    try {
        device.pipelineCache = cacheFolder() / "pipelines";
    } catch (const Error& why) {
        spdlog::warn("{}", why.what());
    }
    return device;
}

std::unique_ptr<Surface> makeSurface(const Window& window, const vk::Device& device) {
    return std::make_unique<Surface>(device.instance(), window.makeSurface(device.instance()));
}

// Sessions that nobody watches are the same whatever was done before.
bool hasHabits(const ViewerOptions& options) { return options.script.empty() && !options.exitFrame; }

ivec2 firstSize(const ViewerOptions& options, const Habits& habits) {
    return options.size.value_or(habits.size.value_or(ivec2(1280, 720)));
}

class Viewer : public ScriptTarget {
  public:
    explicit Viewer(const ViewerOptions& options);
    ~Viewer() override;
    void run();

    void input(InputEvent event) override;
    void resize(int width, int height) override { mWindow.resize(width, height); }
    void screenshot(const std::filesystem::path& file) override;
    void set(const std::string& name, const nlohmann::json& value) override;
    bool isSettled() const override;
    bool isShown() const override { return hasView() && mView.image(); }
    int comparedPasses() const override;
    void quit() override { mWindow.close(); }

  private:
    void takeEvents();
    void take(const InputEvent& event, UiWants wants);
    void open(const std::filesystem::path& file);
    void openFile(const std::filesystem::path& file);
    void resumeSession();
    void obey(Command command);
    void obey(const PanelWishes& wishes);
    void focus();
    void askWhy();
    void reloadShaders();
    void saveLight();
    void saveSession();

    void poll();
    void expectSomething() const;
    void advance(double seconds);
    bool wantsFrame() const;
    bool moves() const;
    double waitSeconds() const;
    void wantFrames(int frames) { mFramesWanted = std::max(mFramesWanted, frames); }

    bool prepareSwapchain();
    void drawFrame();
    bool submitFrame(const vk::Image& target, uint32_t image);
    void drawUi();
    void recordView(const vk::Image& target);
    PanelFacts facts() const;
    Camera camera() const { return mState.orbit->camera(); }
    // A model is shown, from somewhere.
    bool hasView() const { return mContent.shown() && mState.orbit; }

    void save();
    void toggleCapture();
    void toggleRecording();
    void tell(const std::string& words, bool isFailure = false);
    // What fails is told.
    template <typename Work>
    void attempt(Work work);

    ViewerOptions mOptions;
    Habits mHabits;
    Window mWindow;
    vk::Device mDevice;
    std::unique_ptr<Surface> mSurface;
    vk::Swapchain mSwapchain;
    Ui mUi;
    std::unique_ptr<DisplayPass> mDisplay;
    vk::Commands mCommands;

    SceneState mState;
    Controls mControls;
    LampHandles mLamps;
    std::optional<Script> mScript;
    Content mContent;
    SceneView mView;
    PanelPictures mPictures;

    FrameTimes mTimes;
    Outputs mOutputs;
    std::optional<Session> mSession; // that waits for its model, of this bake
    std::filesystem::path mSessionBake;
    std::filesystem::path mTitled; // the bake that the window's title names
    std::string mNotice;
    Clock::time_point mNoticeTime;
    bool mIsFailure = false;
    PanelWishes mWishes; // of the last frame
    bool mNeedsSwapchain = true;
    int mFramesWanted = kFramesAfterInput;
    int mSettledFrames = 0;
    Clock::time_point mLastFrame = Clock::now();
    Worker mWorker{Window::wake}; // last: its work uses all of the above
};

Viewer::Viewer(const ViewerOptions& options)
    : mOptions(options), mHabits(hasHabits(options) ? readHabits() : Habits{}),
      mWindow("Relume", firstSize(options, mHabits)), mDevice(deviceOptions(options, mWindow)),
      mSurface(makeSurface(mWindow, mDevice)), mSwapchain(mDevice, mSurface->handle, options.waitsForDisplay),
      mUi(mWindow, mDevice, mSwapchain),
      mDisplay(std::make_unique<DisplayPass>(mDevice, mSwapchain.format())), mCommands(mDevice, "frame"),
      mContent(
          mDevice, options.device.select, mState.light,
          [this](const std::string& words, bool isFailure) { tell(words, isFailure); }, Window::wake),
      mView(mDevice, Window::wake,
            [this](const std::string& words, bool isFailure) { tell(words, isFailure); }),
      mPictures(mUi.pictures(), Window::wake),
      mOutputs(mDevice, mCommands, [this](const std::string& words) { tell(words); }) {
    for (const auto& [name, value] : mHabits.settings.items()) {
        // Versions without backgrounds stored the exposure even if the user had never set it.
        if (name == "exposure" && !mHabits.settings.contains("background")) continue;
        try {
            applySetting(mState, name, value, nullptr);
        } catch (const std::exception& why) {
            spdlog::debug("a remembered setting is left out: {}", why.what());
        }
    }
    mState.waitsForDisplay &= options.waitsForDisplay;
    mContent.setRecent(mHabits.recent);
    for (const std::filesystem::path& file : mHabits.environments) addEnvironment(mState.light, file);
    if (!options.script.empty()) mScript.emplace(options.script);
    if (!options.timings.empty()) mOutputs.beginCapture(options.timings);
    bool hasModel = false;
    for (const std::filesystem::path& file : options.files) {
        if (!std::filesystem::exists(file))
            throw Error(fmt::format("{}: there is no such file", file.string()));
        const FileKind kind = kindOf(file);
        hasModel |= kind != FileKind::Environment && kind != FileKind::Light;
        openFile(file);
    }
    if (!hasModel) mContent.openBuiltIn();
}

Viewer::~Viewer() {
    mDevice.savePipelineCache();
    if (!hasHabits(mOptions)) return;
    // A window is made as large as this times its scale.
    if (!mWindow.isFullScreen()) mHabits.size = ivec2(vec2(mWindow.size()) / mWindow.scale());
    mHabits.recent = mContent.recent();
    mHabits.environments.clear();
    for (const EnvironmentChoice& choice : mState.light.environments)
        if (choice.kind == EnvironmentChoice::Kind::File && choice.map)
            mHabits.environments.push_back(choice.file);
    nlohmann::json kept = keptSettings(mState);
    if (!mOptions.waitsForDisplay) { // for this time only
        const auto before = mHabits.settings.find("vsync");
        kept["vsync"] = before != mHabits.settings.end() ? *before : nlohmann::json(true);
    }
    mHabits.settings = std::move(kept);
    writeHabits(mHabits);
}

template <typename Work>
void Viewer::attempt(Work work) {
    try {
        work();
    } catch (const std::exception& why) {
        tell(why.what(), true);
    }
}

// Input

void Viewer::input(InputEvent event) {
    event.isScripted = true;
    mWindow.add(std::move(event));
}

void Viewer::screenshot(const std::filesystem::path& file) {
    if (file.extension() != ".png" && file.extension() != ".exr")
        throw Error(fmt::format("\"screenshot\": expected a name ending in .png or .exr, found \"{}\"",
                                file.string()));
    mOutputs.wantScreenshot(file);
}

void Viewer::takeEvents() {
    const UiWants wants = Ui::wants();
    for (const InputEvent& event : mWindow.takeEvents()) {
        wantFrames(kFramesAfterInput);
        take(event, wants);
    }
}

void Viewer::take(const InputEvent& event, UiWants wants) {
    using Kind = InputEvent::Kind;
    if (event.kind == Kind::Drop) {
        for (const std::filesystem::path& file : event.files) open(file);
        return;
    }
    const bool isOfMouse = event.kind != Kind::Key;
    const bool ends = event.kind == Kind::Button && !event.isDown;
    const bool isOfPanels = !event.isScripted && !ends && !mControls.isDragging() && !mLamps.isDragging() &&
                            (isOfMouse ? wants.mouse : wants.keyboard);
    if (isOfPanels) return;
    const Model* const model = mContent.shown().get();
    if (hasView() && isOfMouse && (mState.showsPanels || mLamps.isDragging()) &&
        mLamps.take(event, mState.light, camera(), model->bounds, mWindow.size()))
        return;
    obey(mControls.take(event, mState, mWindow.size(), model ? &model->bounds : nullptr));
}

void Viewer::open(const std::filesystem::path& file) {
    attempt([&] { openFile(file); });
}

void Viewer::openFile(const std::filesystem::path& file) {
    const FileKind kind = kindOf(file);
    if (kind == FileKind::Bake || kind == FileKind::Bakeable) mSession.reset();
    if (kind != FileKind::Session) return mContent.open(file);
    const Session session = readSession(file, mState);
    mContent.open(session.opened);
    mSession = session;
    mState = session.state;
    mSessionBake = kindOf(session.opened) == FileKind::Bake ? session.opened : bakePath(session.opened);
    mContent.remember(file);
}

// The model that a session waits for is there.
void Viewer::resumeSession() {
    if (wholePath(mContent.shown()->file) != wholePath(mSessionBake)) return;
    mState.orbit = orbitOf(mSession->camera);
    mState.keepsOrbit = true;
    mState.material = mSession->material;
    mSession.reset();
}

void Viewer::obey(Command command) {
    const Model* const model = mContent.shown().get();
    switch (command) {
    case Command::None:
        return;
    case Command::Focus:
        return focus();
    case Command::Why:
        return askWhy();
    case Command::Screenshot:
        for (const char* extension : {".png", ".exr"}) mOutputs.wantScreenshot(outputName(extension));
        return;
    case Command::SaveSession:
        return saveSession();
    case Command::Record:
        return toggleRecording();
    case Command::Capture:
        return toggleCapture();
    case Command::ReloadShaders:
        return reloadShaders();
    case Command::FullScreen:
        return mWindow.setFullScreen(!mWindow.isFullScreen());
    case Command::NextEnvironment:
        mState.light.environment = (mState.light.environment + 1) % mState.light.environments.size();
        mState.light.file.reset();
        return;
    case Command::NextMaterial:
        if (model) bindNextMaterial(mState, materialNames(model->asset));
        return;
    case Command::NextModel: {
        const auto& models = mContent.models();
        const auto shown = std::ranges::find(models, mContent.shown());
        if (shown != models.end()) mContent.show(size_t(shown - models.begin() + 1) % models.size());
        return;
    }
    case Command::FewerTerms:
        if (model) addTerms(mState, -1, termsOf(*model));
        return;
    case Command::MoreTerms:
        if (model) addTerms(mState, 1, termsOf(*model));
        return;
    case Command::Quit:
        return mWindow.close();
    }
}

void Viewer::obey(const PanelWishes& wishes) {
    if (wishes.cancelsBake) mContent.cancelBake();
    if (wishes.takesScreenshot) obey(Command::Screenshot);
    if (wishes.togglesCapture) toggleCapture();
    if (wishes.togglesRecording) toggleRecording();
    if (wishes.resetsView) mState.orbit.reset();
    if (wishes.dismissesNotice) mNotice.clear();
    if (wishes.reloadsShaders) reloadShaders();
    if (wishes.savesLight) saveLight();
    if (wishes.savesSession) saveSession();
    if (wishes.opens) open(*wishes.opens);
    if (wishes.shows) mContent.show(*wishes.shows);
    if (wishes.closes) mContent.close(*wishes.closes);
    if (!mState.showsWhy) mPictures.stopAsking();
}

void Viewer::focus() {
    if (!hasView()) return;
    if (const auto hit = pick(*mContent.shown(), camera(), mControls.cursor(), mWindow.size())) {
        const vec3 point = positionOf(*mContent.shown(), *hit);
        // From the same side, with the point in the middle; half as far away.
        mState.orbit->target = point;
        mState.orbit->distance =
            std::max(0.5f * mState.orbit->distance, 0.05f * mContent.shown()->bounds.radius());
    }
}

void Viewer::askWhy() {
    if (!hasView()) return;
    if (mContent.shown()->isSketch) return tell("nothing is baked yet that could say why");
    const auto hit = pick(*mContent.shown(), camera(), mControls.cursor(), mWindow.size());
    if (!hit) {
        mState.showsWhy = false;
        return mPictures.stopAsking();
    }
    const uvec3 corners = mContent.shown()->asset.parts[hit->mesh].mesh.triangles[hit->triangle];
    int nearest = 0;
    for (int c = 1; c < 3; c++)
        if (hit->weights[c] > hit->weights[nearest]) nearest = c;
    mPictures.ask(*mContent.shown(), hit->mesh, corners[nearest]);
    mState.showsWhy = true;
}

// Beside the frames; what is shown stays until all of it is there.
void Viewer::reloadShaders() {
    mWorker.post(
        "building shaders",
        [this]() -> Worker::Result {
            const size_t changed = relume::reloadShaders(mDevice, shaderFolder());
            return [this, changed] {
                tell(changed > 0 ? fmt::format("{} shaders are new", changed) : "no shader has changed");
                if (changed == 0) return;
                mDisplay = std::make_unique<DisplayPass>(mDevice, mSwapchain.format());
                mView.remakePrograms();
                mContent.reload();
            };
        },
        [this](const std::string& why) { tell(why, true); });
}

void Viewer::saveLight() {
    attempt([&] {
        const std::string file = outputName(".light.json");
        writeJsonFile(file, lightFileOf(mState.light));
        tell(fmt::format("{} is written; its turn is --rotate={}", file, mState.light.rotation));
    });
}

void Viewer::saveSession() {
    attempt([&] {
        if (!hasView()) throw Error("nothing is shown yet that a session could keep");
        const SceneState drawn = mView.drawn(mState);
        const std::filesystem::path& bake = mContent.shown()->file;
        const std::string file = outputName(".session.json");
        writeJsonFile(
            file, sessionOf(drawn, mView.fadesGround(mState), bake, mContent.inputOf(bake), mWindow.size()));
        tell(fmt::format("{0} is written; relume render --session {0} -o IMAGE draws it{1}", file,
                         mContent.shown()->isSketch ? " once it is baked" : ""));
    });
}

void Viewer::set(const std::string& name, const nlohmann::json& value) {
    wantFrames(kFramesAfterInput);
    if (name == "environment") {
        mState.light.environment =
            value == "sky" ? 0 : addEnvironment(mState.light, value.get<std::string>());
        mState.light.file.reset();
    } else
        applySetting(mState, name, value, hasView() ? &mContent.shown()->bounds : nullptr);
}

// The loop

void Viewer::run() {
    catchInterrupts();
    while (!mWindow.wantsClose() && !caughtInterrupt()) {
        mWindow.poll(wantsFrame() ? 0 : waitSeconds());
        if (mScript) mScript->step(*this);
        takeEvents();
        poll();
        expectSomething();
        if (mWindow.takeDamage()) wantFrames(1);
        if (mWindow.size() != ivec2(int(mSwapchain.width()), int(mSwapchain.height())))
            mNeedsSwapchain = true;
        if (!wantsFrame()) {
            mLastFrame = Clock::now();
            continue;
        }
        if (mOptions.exitFrame && isSettled()) {
            mSettledFrames++;
            if (mSettledFrames == *mOptions.exitFrame && !mOptions.screenshot.empty())
                mOutputs.wantScreenshot(mOptions.screenshot);
        }
        drawFrame();
        obey(std::exchange(mWishes, {}));
        if (mOptions.exitFrame && mSettledFrames >= *mOptions.exitFrame) break;
    }
    if (mOutputs.isRecording()) mOutputs.endRecording();
    if (mOutputs.isCapturing()) mOutputs.endCapture();
}

void Viewer::poll() {
    if (!mNotice.empty() && !mIsFailure && secondsSince(mNoticeTime) > kNoticeSeconds) {
        mNotice.clear();
        wantFrames(1);
    }
    mWorker.apply();
    if (mContent.poll()) wantFrames(kFramesAfterInput);
    if (mView.poll()) wantFrames(1);
    if (mPictures.poll()) wantFrames(1);
    if (mSession && mContent.shown()) resumeSession();
    if (!mContent.shown() || mContent.shown()->file == mTitled) return;
    mTitled = mContent.shown()->file;
    const std::string name = mTitled.filename().string();
    mWindow.setTitle((name.starts_with(kBuiltInScene) ? kBuiltInScene : name) + " - Relume");
}

// Nobody is there to open something else.
void Viewer::expectSomething() const {
    const bool isReplayed = mOptions.exitFrame || (mScript && mScript->isWaiting());
    if (isReplayed && !mContent.shown() && mIsFailure && mContent.isSettled()) throw Error(mNotice);
}

bool Viewer::moves() const { return mState.turns || mState.light.plays; }

bool Viewer::wantsFrame() const {
    return mFramesWanted > 0 || moves() || mOutputs.isRecording() || mOptions.exitFrame ||
           (mScript && !mScript->hasEnded() && !mScript->isWaiting());
}

// A bake and a script are asked how they are; a signal is seen within a second.
double Viewer::waitSeconds() const {
    return mContent.isBaking() || (mScript && mScript->isWaiting()) ? 0.05 : 1;
}

int Viewer::comparedPasses() const {
    if (!SceneView::compares(mState))
        throw Error(fmt::format(
            "\"passes\": nothing is compared; {{\"set\": {{\"compare\": \"split\"}}}} before, inspect off"));
    const Comparison::Result& compared = mView.compared();
    if (!compared.failure.empty()) throw Error(fmt::format("\"passes\": {}", compared.failure));
    return compared.passes;
}

bool Viewer::isSettled() const {
    return mContent.shown() && mFramesWanted == 0 && mContent.isSettled() && mView.isSettled(mState) &&
           mPictures.isSettled() && mWorker.isIdle();
}

void Viewer::advance(double seconds) {
    if (mState.turns && mState.orbit)
        mState.orbit->azimuth =
            std::remainder(mState.orbit->azimuth + glm::radians(kTurntableDegrees) * float(seconds), 2 * kPi);
    if (mState.light.plays) play(mState.light, seconds);
}

// A frame

// False: there is nothing to draw on.
bool Viewer::prepareSwapchain() {
    if (mSwapchain.hasLostSurface()) {
        std::unique_ptr<Surface> surface = makeSurface(mWindow, mDevice);
        mSwapchain.setSurface(surface->handle);
        mSurface = std::move(surface);
        mNeedsSwapchain = true;
    }
    if (mSwapchain.setWaitsForDisplay(mState.waitsForDisplay)) mNeedsSwapchain = true;
    if (!mNeedsSwapchain) return true;
    const ivec2 size = mWindow.size();
    if (!mSwapchain.resize(uint32_t(size.x), uint32_t(size.y))) {
        mWindow.poll(0.1); // minimised
        return false;
    }
    mUi.resized();
    mNeedsSwapchain = false;
    return true;
}

void Viewer::drawFrame() {
    const Clock::time_point start = Clock::now();
    if (!prepareSwapchain()) return;
    const vk::FrameSpan frame(mOutputs.capture());
    const std::optional<uint32_t> image = mSwapchain.acquire();
    if (!image) {
        mNeedsSwapchain = true;
        return;
    }
    advance(mOutputs.isRecording() ? 1 / Recorder::kFramesPerSecond
                                   : std::min(secondsSince(mLastFrame), 0.25));
    mLastFrame = start;
    drawUi();

    const vk::Image& target = mSwapchain.images()[*image];
    mCommands.clearTimes();
    bool isRead = submitFrame(target, *image);
    // A new light is never shown with the exposure of the last one.
    if (mView.submitted(mState)) isRead = submitFrame(target, *image);
    if (mView.image()) mPictures.update(mState, mContent.shown(), mView);
    if (isRead) save();
    if (!mSwapchain.present(*image)) mNeedsSwapchain = true;
    mTimes.add(secondsSince(start), mCommands.times());
    mFramesWanted = std::max(0, mFramesWanted - 1);
    // One frame draws all samples; a second one notices that the view is still.
    if (!moves() && mView.isDraft(mState)) wantFrames(2);
}

// True: the window's image is to be read.
bool Viewer::submitFrame(const vk::Image& target, uint32_t image) {
    mCommands.begin();
    mUi.pictures().record(mCommands);
    recordView(target);
    mUi.record(mCommands, image);
    const bool isRead = mOutputs.record(target);
    mCommands.transition(
        target, isRead ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, isRead ? vk::Stage::Transfer : vk::Stage::Color, vk::Stage::Host);
    mCommands.submitAndWait();
    return isRead;
}

void Viewer::drawUi() {
    mUi.setDark(mState.isDark);
    mUi.begin();
    const PanelFacts known = facts();
    if (hasView() && mState.showsPanels) {
        mLamps.draw(mState.light, camera(), mContent.shown()->bounds, mWindow.size());
        drawOverlay(mState, known, camera(), mWindow.size());
    }
    mWishes = drawPanels(mState, known);
    mUi.end();
}

void Viewer::recordView(const vk::Image& target) {
    const vec3 background = mState.isDark ? vec3(0.11f, 0.12f, 0.14f) : vec3(0.75f, 0.77f, 0.8f);
    const ivec2 size(int(mSwapchain.width()), int(mSwapchain.height()));
    if (mContent.shown()) mView.record(mCommands, mState, mContent.shown(), size, mOutputs.wantsFrame());
    if (const vk::Image* const view = mView.image()) {
        const bool isFalse = mView.isFalseColor(mState);
        mDisplay->record(
            mCommands, *view, target,
            {isFalse ? ToneCurve::None : mState.tone, isFalse ? 0 : mState.exposure, background});
        return;
    }
    mCommands.transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                         vk::Stage::Color, vk::Stage::Color);
    mCommands.render({.color = &target, .clear = {background.x, background.y, background.z, 1}}, [] {});
}

PanelFacts Viewer::facts() const {
    PanelFacts facts;
    facts.content = &mContent;
    facts.times = &mTimes;
    facts.pictures = &mUi.pictures();
    facts.device = mDevice.name();
    facts.memory = memoryInUse();
    facts.isCapturing = mOutputs.isCapturing();
    facts.isRecording = mOutputs.isRecording();
    facts.notice = mNotice;
    facts.isFailure = mIsFailure;
    facts.light = mView.lightStats();
    facts.passes = mView.compared().passes;
    facts.error = mView.compared().error;
    mPictures.describe(facts);
    if (!mContent.shown()) return facts;
    const Asset& asset = mContent.shown()->asset;
    facts.materials = materialNames(asset);
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            if (set.materials.size() > 1) {
                auto& names = facts.materialSets.emplace_back();
                for (const AssetMaterial& material : set.materials) names.push_back(material.name);
            }
    return facts;
}

// Files

void Viewer::save() {
    const Model* const model = mView.image() ? mContent.shown().get() : nullptr;
    if (mOptions.exitFrame)
        return mOutputs.save(mView.drawn(mState), model,
                             mView.fadesGround(mState)); // nobody else sees what fails
    attempt([&] { mOutputs.save(mView.drawn(mState), model, mView.fadesGround(mState)); });
}

void Viewer::toggleRecording() {
    attempt([&] { mOutputs.isRecording() ? mOutputs.endRecording() : mOutputs.beginRecording(); });
}

void Viewer::toggleCapture() {
    attempt(
        [&] { mOutputs.isCapturing() ? mOutputs.endCapture() : mOutputs.beginCapture(outputName(".json")); });
}

void Viewer::tell(const std::string& words, bool isFailure) {
    if (isFailure)
        spdlog::error("{}", words);
    else
        spdlog::info("{}", words);
    mNotice = words;
    mNoticeTime = Clock::now();
    mIsFailure = isFailure;
    wantFrames(2);
}

} // namespace

void runViewer(const ViewerOptions& options) {
    Viewer viewer(options);
    viewer.run();
}

} // namespace relume
