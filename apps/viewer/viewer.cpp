#include "apps/viewer/viewer.h"

#include "apps/viewer/controls.h"
#include "apps/viewer/habits.h"
#include "apps/viewer/lamp_handles.h"
#include "apps/viewer/memory_use.h"
#include "apps/viewer/opened_file.h"
#include "apps/viewer/overlay.h"
#include "apps/viewer/panel_pictures.h"
#include "apps/viewer/recorder.h"
#include "apps/viewer/screenshot.h"
#include "apps/viewer/script.h"
#include "apps/viewer/settings.h"
#include "apps/viewer/shader_compiler.h"
#include "apps/viewer/surface.h"
#include "apps/viewer/ui.h"
#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/interrupt.h"
#include "engine/image/image_file.h"
#include "engine/render/display_pass.h"
#include "engine/vk/timing_capture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
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

std::string timeStamp() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
    return text;
}

vk::DeviceOptions deviceOptions(const ViewerOptions& options, const Window& window) {
    vk::DeviceOptions device = options.device;
    device.surfaceExtensions = window.surfaceExtensions();
    device.pipelineCache = cacheFolder() / "pipelines";
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
    void screenshot(const std::filesystem::path& file) override { mScreenshots.push_back(file); }
    void set(const std::string& name, const nlohmann::json& value) override;
    bool isSettled() const override;
    int comparedPasses() const override { return mView.compared().passes; }
    void quit() override { mWindow.close(); }

  private:
    void takeEvents();
    void take(const InputEvent& event, UiWants wants);
    void open(const std::filesystem::path& file);
    void obey(Command command);
    void obey(const PanelWishes& wishes);
    void changeTerms(int by);
    void nextMaterial();
    void focus();
    void askWhy();
    void reloadShaders();
    void saveLight();

    void poll();
    void expectSomething() const;
    void advance(double seconds);
    bool wantsFrame() const;
    bool moves() const;
    double waitSeconds() const;
    void wantFrames(int frames) { mFramesWanted = std::max(mFramesWanted, frames); }

    bool prepareSwapchain();
    void drawFrame();
    void drawUi();
    void recordView(const vk::Image& target);
    bool recordReadback(const vk::Image& target);
    PanelFacts facts() const;
    Camera camera() const { return mState.orbit->camera(); }
    // A model is shown, from somewhere.
    bool hasView() const { return mContent.shown() && mState.orbit; }

    void saveScreenshots();
    void saveScreenshot(const std::filesystem::path& file, const Image& screen);
    void toggleCapture();
    void beginCapture(const std::filesystem::path& file);
    void endCapture();
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
    std::optional<vk::TimingCapture> mCapture;
    std::filesystem::path mCaptureFile;
    std::unique_ptr<Recorder> mRecorder;
    std::vector<std::filesystem::path> mScreenshots;
    vk::Buffer mScreen; // of the window, on its way to a file
    std::string mNotice;
    Clock::time_point mNoticeTime;
    bool mIsFailure = false;
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
      mPictures(mUi.pictures(), Window::wake) {
    for (const auto& [name, value] : mHabits.settings.items()) {
        try {
            applySetting(mState, name, value, nullptr);
        } catch (const std::exception& why) {
            spdlog::debug("a remembered setting is left out: {}", why.what());
        }
    }
    mState.waitsForDisplay &= options.waitsForDisplay;
    mContent.setRecent(mHabits.recent);
    for (const std::filesystem::path& file : mHabits.environments) mContent.addEnvironment(file);
    if (!options.script.empty()) mScript.emplace(options.script);
    if (!options.timings.empty()) beginCapture(options.timings);
    bool hasModel = false;
    for (const std::filesystem::path& file : options.files) {
        if (!std::filesystem::exists(file)) throw Error("{}: there is no such file", file.string());
        const FileKind kind = kindOf(file);
        hasModel |= kind == FileKind::Bake || kind == FileKind::Bakeable;
        mContent.open(file);
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
    mHabits.settings = keptSettings(mState);
    writeHabits(mHabits);
}

template <typename Work>
void Viewer::attempt(Work work) {
    try {
        work();
    } catch (const Error& why) {
        tell(why.what(), true);
    }
}

// Input

void Viewer::input(InputEvent event) {
    event.isScripted = true;
    mWindow.add(std::move(event));
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
    if (hasView() && isOfMouse && mState.showsPanels &&
        mLamps.take(event, mState.light, camera(), model->bounds, mWindow.size()))
        return;
    obey(mControls.take(event, mState, mWindow.size(), model ? &model->bounds : nullptr));
}

void Viewer::open(const std::filesystem::path& file) {
    attempt([&] { mContent.open(file); });
}

void Viewer::obey(Command command) {
    switch (command) {
    case Command::None:
        return;
    case Command::Focus:
        return focus();
    case Command::Why:
        return askWhy();
    case Command::Screenshot:
        for (const char* extension : {".png", ".exr"})
            mScreenshots.push_back("relume-" + timeStamp() + extension);
        return;
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
        return nextMaterial();
    case Command::NextModel: {
        const auto& models = mContent.models();
        const auto shown = std::ranges::find(models, mContent.shown());
        if (shown != models.end()) mContent.show(size_t(shown - models.begin() + 1) % models.size());
        return;
    }
    case Command::FewerTerms:
        return changeTerms(-1);
    case Command::MoreTerms:
        return changeTerms(1);
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
    if (wishes.opens) open(*wishes.opens);
    if (wishes.shows) mContent.show(*wishes.shows);
    if (wishes.closes) mContent.close(*wishes.closes);
    if (!mState.showsWhy) mPictures.stopAsking();
}

void Viewer::changeTerms(int by) {
    if (!mContent.shown()) return;
    const int most = termsOf(*mContent.shown());
    const int terms = std::clamp((mState.terms > 0 ? mState.terms : most) + by, 1, most);
    mState.terms = terms < most ? terms : 0;
}

void Viewer::nextMaterial() {
    if (!mContent.shown()) return;
    const std::vector<std::string> names = materialNames(mContent.shown()->asset);
    const auto worn =
        mState.material.empty() ? names.end() : std::ranges::find(names, mState.material[0].name);
    const size_t next = worn == names.end() ? 0 : size_t(worn - names.begin()) + 1;
    mState.material.clear();
    if (next < names.size()) mState.material.push_back({names[next]});
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
    const auto hit = pick(*mContent.shown(), camera(), mControls.cursor(), mWindow.size());
    if (!hit) {
        mState.showsWhy = false;
        return mPictures.stopAsking();
    }
    const uvec3 corners = mContent.shown()->asset.parts[hit->mesh].mesh.triangles[hit->triangle];
    int nearest = 0;
    for (int c = 1; c < 3; c++)
        if (hit->weights[c] > hit->weights[nearest]) nearest = c;
    mPictures.ask(hit->mesh, corners[nearest]);
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
        const std::optional<nlohmann::json> light = lightFileOf(mState.light);
        if (!light) throw Error("the built-in sky has no file; choose another environment to save a light");
        const std::string file = "relume-" + timeStamp() + ".light.json";
        writeFileAtomically(file, light->dump(2) + "\n");
        tell(fmt::format("{} is written; its turn is --rotate={}", file, mState.light.rotation));
    });
}

void Viewer::set(const std::string& name, const nlohmann::json& value) {
    wantFrames(kFramesAfterInput);
    if (name == "environment") {
        mState.light.environment = value == "sky" ? 0 : mContent.addEnvironment(value.get<std::string>());
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
                mScreenshots.push_back(mOptions.screenshot);
        }
        drawFrame();
        if (mOptions.exitFrame && mSettledFrames >= *mOptions.exitFrame) break;
    }
    if (mRecorder) toggleRecording();
    if (mCapture) endCapture();
}

void Viewer::poll() {
    const Model* const before = mContent.shown().get();
    if (!mNotice.empty() && !mIsFailure && secondsSince(mNoticeTime) > kNoticeSeconds) {
        mNotice.clear();
        wantFrames(1);
    }
    mWorker.apply();
    if (mContent.poll()) wantFrames(kFramesAfterInput);
    if (mView.poll()) wantFrames(1);
    if (mPictures.poll()) wantFrames(1);
    const Model* const model = mContent.shown().get();
    if (model == before || !model) return;
    mWindow.setTitle(
        (model->file == bakePath("") ? std::string("built-in scene") : model->file.filename().string()) +
        " - Relume");
}

// Nobody is there to open something else.
void Viewer::expectSomething() const {
    const bool isReplayed = mOptions.exitFrame || (mScript && mScript->isWaiting());
    if (isReplayed && !mContent.shown() && mIsFailure && mContent.isSettled()) throw Error("{}", mNotice);
}

bool Viewer::moves() const { return mState.turns || mState.light.plays; }

bool Viewer::wantsFrame() const {
    return mFramesWanted > 0 || moves() || mRecorder || mOptions.exitFrame ||
           (mScript && !mScript->hasEnded() && !mScript->isWaiting());
}

// A bake and a script are asked how they are; a signal is seen within a second.
double Viewer::waitSeconds() const {
    return mContent.isBaking() || (mScript && mScript->isWaiting()) ? 0.05 : 1;
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
    const vk::FrameSpan frame(mCapture ? &*mCapture : nullptr);
    const std::optional<uint32_t> image = mSwapchain.acquire();
    if (!image) {
        mNeedsSwapchain = true;
        return;
    }
    advance(mRecorder ? 1 / Recorder::kFramesPerSecond : std::min(secondsSince(mLastFrame), 0.25));
    mLastFrame = start;
    drawUi();

    const vk::Image& target = mSwapchain.images()[*image];
    mCommands.clearTimes();
    mCommands.begin();
    mUi.pictures().record(mCommands);
    recordView(target);
    mUi.record(mCommands, *image);
    const bool isRead = recordReadback(target);
    mCommands.transition(
        target, isRead ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, isRead ? vk::Stage::Transfer : vk::Stage::Color, vk::Stage::Host);
    mCommands.submitAndWait();
    mView.submitted(mState);
    if (mView.image()) mPictures.update(mState, mContent.shown(), mView);
    if (isRead) saveScreenshots();
    if (!mSwapchain.present(*image)) mNeedsSwapchain = true;
    mTimes.add(secondsSince(start), mCommands.times());
    mFramesWanted = std::max(0, mFramesWanted - 1);
}

void Viewer::drawUi() {
    mUi.setDark(mState.isDark);
    mUi.begin();
    const PanelFacts known = facts();
    if (hasView() && mState.showsPanels) {
        mLamps.draw(mState.light, camera(), mContent.shown()->bounds, mWindow.size());
        drawOverlay(mState, known, camera(), mWindow.size());
    }
    obey(drawPanels(mState, known));
    mUi.end();
}

void Viewer::recordView(const vk::Image& target) {
    const vec3 background = mState.isDark ? vec3(0.11f, 0.12f, 0.14f) : vec3(0.75f, 0.77f, 0.8f);
    const ivec2 size(int(mSwapchain.width()), int(mSwapchain.height()));
    if (mContent.shown()) mView.record(mCommands, mState, mContent.shown(), size);
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

// Where the window's image is wanted; then it is in TRANSFER_SRC_OPTIMAL.
bool Viewer::recordReadback(const vk::Image& target) {
    if (mScreenshots.empty() && !mRecorder) return false;
    const uint64_t bytes = uint64_t(4) * mSwapchain.width() * mSwapchain.height();
    if (mScreen.bytes() != bytes) mScreen = vk::Buffer(mDevice, bytes, vk::BufferUse::Readback, "screenshot");
    mCommands.transition(target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Color, vk::Stage::Transfer);
    mCommands.copy(target, mScreen, 1);
    mCommands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    return true;
}

PanelFacts Viewer::facts() const {
    PanelFacts facts;
    facts.content = &mContent;
    facts.times = &mTimes;
    facts.pictures = &mUi.pictures();
    facts.device = mDevice.name();
    facts.memory = memoryInUse();
    facts.isCapturing = mCapture.has_value();
    facts.isRecording = mRecorder != nullptr;
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

void Viewer::saveScreenshots() {
    const Image screen = screenImage(mScreen.map<uint8_t>(), int(mSwapchain.width()),
                                     int(mSwapchain.height()), mSwapchain.format());
    if (mRecorder) mRecorder->add(screen);
    for (const std::filesystem::path& file : std::exchange(mScreenshots, {})) {
        try {
            saveScreenshot(file, screen);
            tell(file.string() + " is written");
        } catch (const Error& why) {
            if (mOptions.exitFrame) throw; // nobody else will see it
            tell(why.what(), true);
        }
    }
}

void Viewer::saveScreenshot(const std::filesystem::path& file, const Image& screen) {
    if (file.extension() != ".exr") return writePng(file, screen);
    if (!mView.image()) throw Error("{}: nothing is shown yet", file.string());
    const Model& model = *mContent.shown();
    writeExr(file, model.view.read());
    if (mState.inspect != Inspect::Off) return; // no command draws it
    std::filesystem::path light = file;
    light.replace_extension(".light.json");
    if (needsLightFile(mState.light)) {
        const std::optional<nlohmann::json> values = lightFileOf(mState.light);
        if (!values) return; // no file says it
        writeFileAtomically(light, values->dump(2) + "\n");
    }
    spdlog::info("the same: {}",
                 renderCommand(mState, model.file, int(mSwapchain.width()), int(mSwapchain.height()), light));
}

void Viewer::toggleRecording() {
    attempt([&] {
        if (!mRecorder) {
            mRecorder = std::make_unique<Recorder>("relume-" + timeStamp());
            return tell("recording; Ctrl + F12 ends it");
        }
        const std::unique_ptr<Recorder> ended = std::move(mRecorder);
        ended->finish();
        tell(fmt::format("{}: {} images", ended->folder().string(), ended->frames()));
    });
}

void Viewer::toggleCapture() {
    attempt([&] {
        if (mCapture)
            endCapture();
        else
            beginCapture("relume-" + timeStamp() + ".json");
    });
}

void Viewer::beginCapture(const std::filesystem::path& file) {
    expectTimingFile(file);
    mCaptureFile = file;
    mCapture.emplace();
    mCapture->attach(mDevice);
    mCommands.setCapture(&*mCapture);
    tell("capturing times; F9 ends it");
}

void Viewer::endCapture() {
    mCommands.setCapture(nullptr);
    const TimingTrace trace = mCapture->trace();
    mCapture.reset();
    writeTimings(mCaptureFile, trace);
    tell(mCaptureFile.string() + " is written");
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
