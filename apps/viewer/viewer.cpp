#include "apps/viewer/viewer.h"

#include "apps/viewer/bake_process.h"
#include "apps/viewer/controls.h"
#include "apps/viewer/model.h"
#include "apps/viewer/opened_file.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/screenshot.h"
#include "apps/viewer/script.h"
#include "apps/viewer/settings.h"
#include "apps/viewer/ui.h"
#include "apps/viewer/worker.h"
#include "engine/base/error.h"
#include "engine/image/image_file.h"
#include "engine/light/light_file.h"
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

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

vk::DeviceOptions withSurfaces(vk::DeviceOptions options, const Window& window) {
    options.surfaceExtensions = window.surfaceExtensions();
    return options;
}

struct Surface {
    Surface(VkInstance owner, VkSurfaceKHR surface) : instance(owner), handle(surface) {}
    ~Surface() { vkDestroySurfaceKHR(instance, handle, nullptr); }
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    VkInstance instance;
    VkSurfaceKHR handle;
};

// What the tuples on the device were made for.
struct ShownLight {
    const Environment* map = nullptr;
    const MovingLight* file = nullptr;
    float gain = 1, rotation = 0;
    double seconds = 0;
    std::vector<LampChoice> lamps;
    int threshold = 0;

    bool operator==(const ShownLight&) const = default;
};

struct ShownView {
    vec3 eye{0}, target{0};
    float fov = 0;
    int width = 0, height = 0;

    bool operator==(const ShownView&) const = default;
};

std::string timeStamp() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
    return text;
}

class Viewer : public ScriptTarget {
  public:
    explicit Viewer(const ViewerOptions& options);
    void run();

    void input(InputEvent event) override { mWindow.add(std::move(event)); }
    void resize(int width, int height) override { mWindow.resize(width, height); }
    void screenshot(const std::filesystem::path& file) override { mScreenshots.push_back(file); }
    void set(const std::string& name, const nlohmann::json& value) override;
    bool isSettled() const override;
    void quit() override { mWindow.close(); }

  private:
    void open(const std::filesystem::path& file);
    void bake(const std::filesystem::path& input);
    void load(const std::filesystem::path& bake);
    void show(std::unique_ptr<Model> model);
    void addEnvironment(const std::filesystem::path& file);
    void readEnvironmentOf(size_t choice);
    void openLight(const std::filesystem::path& file);

    void takeEvents();
    void obey(Command command);
    void obey(const PanelWishes& wishes);
    void pollBake();
    void expectSomething() const;
    void advance(double seconds);
    bool wantsFrame() const;
    bool moves() const;
    double waitSeconds() const;

    void drawFrame();
    void drawModel();
    PanelFacts facts() const;
    Light lightNow();
    Camera cameraNow();
    void wearChosen();
    void saveScreenshots();
    void toggleCapture();
    void beginCapture(const std::filesystem::path& file);
    void endCapture();
    void tell(const std::string& words, bool isFailure = false);

    ViewerOptions mOptions;
    Window mWindow;
    vk::Device mDevice;
    Surface mSurface;
    vk::Swapchain mSwapchain;
    Ui mUi;
    DisplayPass mDisplay;
    vk::Commands mCommands;
    Worker mWorker;
    std::unique_ptr<BakeProcess> mBake;
    bool mMustReload = false; // the bake in hand has written since it was read
    std::unique_ptr<Model> mModel;

    SceneState mState;
    Controls mControls;
    std::optional<Script> mScript;
    std::string mShownMaterial;
    std::optional<ShownLight> mShownLight;
    std::optional<ShownView> mShownView;
    std::optional<LightStats> mLightStats;
    bool mNeedsSwapchain = true;

    FrameTimes mTimes;
    std::optional<vk::TimingCapture> mCapture;
    std::filesystem::path mCaptureFile;
    std::vector<std::filesystem::path> mScreenshots;
    vk::Buffer mScreen; // of the window, on its way to a screenshot
    std::string mNotice;
    bool mIsFailure = false;
    int mFramesWanted = kFramesAfterInput;
    int mSettledFrames = 0;
    Clock::time_point mLastFrame = Clock::now();
};

Viewer::Viewer(const ViewerOptions& options)
    : mOptions(options), mWindow("Relume", options.width, options.height),
      mDevice(withSurfaces(options.device, mWindow)),
      mSurface(mDevice.instance(), mWindow.makeSurface(mDevice.instance())),
      mSwapchain(mDevice, mSurface.handle, options.waitsForDisplay), mUi(mWindow, mDevice, mSwapchain),
      mDisplay(mDevice, mSwapchain.format()), mCommands(mDevice, "frame"), mWorker([] { Window::wake(); }) {
    mState.light.environments.push_back({"sky", {}, nullptr, false});
    if (!options.script.empty()) mScript.emplace(options.script);
    if (!options.timings.empty()) beginCapture(options.timings);
    bool hasModel = false;
    for (const std::filesystem::path& file : options.files) {
        if (!std::filesystem::exists(file)) throw Error("{}: there is no such file", file.string());
        const FileKind kind = kindOf(file);
        hasModel |= kind == FileKind::Bake || kind == FileKind::Bakeable;
        open(file);
    }
    if (!hasModel) bake("");
}

// Opening

void Viewer::open(const std::filesystem::path& file) {
    switch (kindOf(file)) {
    case FileKind::Bake:
        mBake.reset();
        load(file);
        return;
    case FileKind::Bakeable:
        bake(file);
        return;
    case FileKind::Environment:
        addEnvironment(file);
        return;
    case FileKind::Light:
        openLight(file);
        return;
    }
}

void Viewer::bake(const std::filesystem::path& input) {
    const std::filesystem::path output = bakePath(input);
    mBake.reset();
    std::vector<std::string> options;
    if (input.extension() != ".json") options = {"--ground", "--ground-tessellation", "64"};
    if (!mOptions.device.select.empty()) options.insert(options.end(), {"--device", mOptions.device.select});
    const bool isThere = std::filesystem::exists(output);
    if (isThere) load(output);
    if (!isThere || std::filesystem::exists(output.string() + ".checkpoint"))
        mBake = std::make_unique<BakeProcess>(input, output, options);
}

void Viewer::load(const std::filesystem::path& bake) {
    mMustReload = false;
    mWorker.post(
        "reading " + bake.filename().string(),
        [this, bake]() -> Worker::Result {
            auto model = std::make_shared<std::unique_ptr<Model>>(std::make_unique<Model>(mDevice, bake));
            return [this, model] { show(std::move(*model)); };
        },
        [this](const std::string& why) { tell(why, true); });
}

void Viewer::show(std::unique_ptr<Model> model) {
    if (!mModel || mModel->file != model->file) mState.orbit.reset();
    mModel = std::move(model);
    mShownLight.reset();
    mShownView.reset();
    mShownMaterial.clear();
    mLightStats.reset();
    const std::vector<std::string> names = materialNames(mModel->asset);
    if (std::ranges::find(names, mState.material) == names.end()) mState.material.clear();
    const bool isBuiltIn = mModel->file == bakePath("");
    mWindow.setTitle((isBuiltIn ? std::string("built-in scene") : mModel->file.filename().string()) +
                     " - Relume");
    mFramesWanted = kFramesAfterInput;
}

void Viewer::addEnvironment(const std::filesystem::path& file) {
    std::vector<EnvironmentChoice>& choices = mState.light.environments;
    const auto known = std::ranges::find(choices, file, &EnvironmentChoice::file);
    mState.light.environment = size_t(known - choices.begin());
    if (known == choices.end()) choices.push_back({file.stem().string(), file, nullptr, false});
    mState.light.file.reset();
}

void Viewer::readEnvironmentOf(size_t number) {
    EnvironmentChoice& choice = mState.light.environments[number];
    if (choice.isRead) return;
    choice.isRead = true;
    mWorker.post(
        "reading " + choice.name,
        [this, number, file = choice.file]() -> Worker::Result {
            auto map = std::make_shared<const Environment>(
                prepareForSampling(file.empty() ? makeSky() : readEnvironment(file)));
            return [this, number, map] {
                mState.light.environments[number].map = map;
                mFramesWanted = kFramesAfterInput;
            };
        },
        [this, number](const std::string& why) {
            tell(why, true);
            if (mState.light.environment == number) mState.light.environment = 0;
        });
}

void Viewer::openLight(const std::filesystem::path& file) {
    mWorker.post(
        "reading " + file.filename().string(),
        [this, file]() -> Worker::Result {
            auto light = std::make_shared<MovingLight>(readLight(file));
            return [this, light, file] {
                mState.light.file = light;
                mState.light.fileName = file;
                mState.light.seconds = 0;
                mFramesWanted = kFramesAfterInput;
            };
        },
        [this](const std::string& why) { tell(why, true); });
}

// Input

void Viewer::takeEvents() {
    const UiWants wants = Ui::wants();
    for (const InputEvent& event : mWindow.takeEvents()) {
        mFramesWanted = kFramesAfterInput;
        using Kind = InputEvent::Kind;
        if (event.kind == Kind::Drop) {
            for (const std::filesystem::path& file : event.files) {
                try {
                    open(file);
                } catch (const Error& why) {
                    tell(why.what(), true);
                }
            }
            continue;
        }
        const bool isOfMouse = event.kind != Kind::Key;
        const bool ends = event.kind == Kind::Button && !event.isDown;
        if (!ends && !mControls.isDragging() && (isOfMouse ? wants.mouse : wants.keyboard)) continue;
        obey(mControls.take(event, mState, mWindow.size(), mModel ? &mModel->bounds : nullptr));
    }
}

void Viewer::obey(Command command) {
    switch (command) {
    case Command::None:
        return;
    case Command::Screenshot:
        for (const char* extension : {".png", ".exr"})
            mScreenshots.push_back("relume-" + timeStamp() + extension);
        return;
    case Command::Capture:
        toggleCapture();
        return;
    case Command::FullScreen:
        mWindow.setFullScreen(!mWindow.isFullScreen());
        return;
    case Command::NextEnvironment:
        mState.light.environment = (mState.light.environment + 1) % mState.light.environments.size();
        return;
    case Command::NextMaterial: {
        if (!mModel) return;
        const std::vector<std::string> names = materialNames(mModel->asset);
        const auto worn = std::ranges::find(names, mState.material);
        const size_t next = worn == names.end() ? 0 : size_t(worn - names.begin()) + 1;
        mState.material = next < names.size() ? names[next] : "";
        return;
    }
    case Command::Quit:
        mWindow.close();
        return;
    }
}

void Viewer::obey(const PanelWishes& wishes) {
    if (wishes.cancelsBake) mBake.reset();
    if (wishes.takesScreenshot) obey(Command::Screenshot);
    if (wishes.togglesCapture) toggleCapture();
    if (wishes.resetsView) mState.orbit.reset();
    if (wishes.dismissesNotice) mNotice.clear();
}

void Viewer::set(const std::string& name, const nlohmann::json& value) {
    mFramesWanted = kFramesAfterInput;
    if (mModel) cameraNow(); // where it is by default, it is so that it can be changed
    if (name == "environment" && value != "sky")
        addEnvironment(value.get<std::string>());
    else
        applySetting(mState, name, value, mModel ? &mModel->bounds : nullptr);
}

// The loop

void Viewer::run() {
    while (!mWindow.wantsClose()) {
        mWindow.poll(wantsFrame() ? 0 : waitSeconds());
        if (mScript) mScript->step(*this);
        takeEvents();
        mWorker.apply();
        pollBake();
        expectSomething();
        if (mWindow.takeDamage()) mFramesWanted = std::max(mFramesWanted, 1);
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
    if (mCapture) endCapture();
}

// Nobody is there to open something else.
void Viewer::expectSomething() const {
    const bool isReplayed = mOptions.exitFrame || (mScript && mScript->isWaiting());
    if (isReplayed && !mModel && mIsFailure && mWorker.isIdle() && !mBake) throw Error("{}", mNotice);
}

bool Viewer::moves() const {
    return mState.turns || (mState.light.plays && mState.light.file && mState.light.file->moves());
}

bool Viewer::wantsFrame() const {
    return mFramesWanted > 0 || moves() || mOptions.exitFrame ||
           (mScript && !mScript->hasEnded() && !mScript->isWaiting());
}

double Viewer::waitSeconds() const { return mBake || (mScript && mScript->isWaiting()) ? 0.05 : 3600; }

bool Viewer::isSettled() const {
    const EnvironmentChoice& choice = mState.light.environments[mState.light.environment];
    return mModel && mFramesWanted == 0 && mWorker.isIdle() && !(mBake && mBake->isRunning()) &&
           !mMustReload && mShownLight && (mState.light.file || choice.map);
}

void Viewer::pollBake() {
    if (!mBake) return;
    const BakeProgress before = mBake->progress();
    mMustReload |= mBake->poll();
    if (mBake->progress().fraction != before.fraction || mBake->progress().stage != before.stage)
        mFramesWanted = std::max(mFramesWanted, 1);
    if (mMustReload && mWorker.isIdle()) load(mBake->output());
    if (mBake->isRunning() || mMustReload) return;
    if (!mBake->failure().empty()) tell(mBake->failure(), true);
    mBake.reset();
    mFramesWanted = std::max(mFramesWanted, 1);
}

void Viewer::advance(double seconds) {
    if (mState.turns && mState.orbit)
        mState.orbit->azimuth =
            std::remainder(mState.orbit->azimuth + glm::radians(kTurntableDegrees) * float(seconds), 2 * kPi);
    if (moves() && mState.light.plays) mState.light.seconds += seconds;
}

// A frame

Camera Viewer::cameraNow() {
    if (!mState.orbit) {
        const ivec2 size = glm::max(mWindow.size(), ivec2(1));
        mState.orbit =
            defaultOrbit(mModel->bounds, glm::radians(mState.fovDegrees), float(size.x) / float(size.y));
    }
    return mState.orbit->camera();
}

Light Viewer::lightNow() {
    if (mState.light.file) {
        try {
            return mState.light.file->at(mState.light.seconds);
        } catch (const Error& why) { // a sequence's file that is gone
            tell(why.what(), true);
            mState.light.file.reset();
        }
    }
    Light light;
    const EnvironmentChoice& choice = mState.light.environments[mState.light.environment];
    if (choice.map) light.environments.push_back({choice.map, 0, mState.light.environmentGain});
    for (const LampChoice& lamp : mState.light.lamps) light.lamps.push_back(lampOf(lamp));
    return light;
}

void Viewer::wearChosen() {
    if (mShownMaterial == mState.material) return;
    Appearance appearance = defaultAppearance(mModel->asset);
    const WeightedMaterial chosen{mState.material};
    try {
        if (!mState.material.empty()) wear(appearance, mModel->asset, {&chosen, 1});
    } catch (const Error& why) {
        tell(why.what(), true);
        mState.material = mShownMaterial;
        return;
    }
    mShownMaterial = mState.material;
    mModel->appearance = std::move(appearance);
    mModel->view.setAppearance(mModel->appearance);
    mShownLight.reset(); // another set's tuples
    mShownView.reset();
}

void Viewer::drawModel() {
    readEnvironmentOf(mState.light.environment);
    wearChosen();
    const LightState& light = mState.light;
    const EnvironmentChoice& choice = light.environments[light.environment];
    if (!light.file && !choice.map && mShownLight) {
        // The light before, until the one chosen is there.
    } else if (const ShownLight now{choice.map.get(), light.file.get(), light.environmentGain, light.rotation,
                                    light.seconds, light.lamps, light.selection.threshold};
               mShownLight != now) {
        mModel->light.setLight(lightNow());
        mModel->light.record(mCommands, glm::radians(light.rotation), light.selection);
        mModel->relighter.record(mCommands, mModel->light, mModel->appearance);
        mShownLight = now;
        mShownView.reset();
        mLightStats.reset();
    }
    const Camera camera = cameraNow();
    const ShownView view{camera.eye, camera.target, camera.verticalFov, int(mSwapchain.width()),
                         int(mSwapchain.height())};
    if (mShownView == view) return;
    const vk::ImageOptions& size = mModel->view.image().options();
    if (size.width != mSwapchain.width() || size.height != mSwapchain.height())
        mModel->view.resize(view.width, view.height);
    mModel->view.record(mCommands, camera, mModel->relighter);
    mShownView = view;
}

void Viewer::drawFrame() {
    const Clock::time_point start = Clock::now();
    if (mNeedsSwapchain) {
        const ivec2 size = mWindow.size();
        if (!mSwapchain.resize(uint32_t(size.x), uint32_t(size.y))) {
            mWindow.poll(0.1); // minimised
            return;
        }
        mUi.resized();
        mNeedsSwapchain = false;
    }
    const vk::FrameSpan frame(mCapture ? &*mCapture : nullptr);
    const std::optional<uint32_t> image = mSwapchain.acquire();
    if (!image) {
        mNeedsSwapchain = true;
        return;
    }
    advance(std::min(secondsSince(mLastFrame), 0.25));
    mLastFrame = start;

    mUi.setDark(mState.isDark);
    mUi.begin();
    obey(drawPanels(mState, facts()));
    mUi.end();

    const vk::Image& target = mSwapchain.images()[*image];
    const vec3 background = mState.isDark ? vec3(0.11f, 0.12f, 0.14f) : vec3(0.75f, 0.77f, 0.8f);
    mCommands.clearTimes();
    mCommands.begin();
    if (mModel) {
        drawModel();
        mDisplay.record(mCommands, mModel->view.image(), target, {mState.tone, mState.exposure, background});
    } else {
        mCommands.transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                             vk::Stage::Color, vk::Stage::Color);
        mCommands.render({.color = &target, .clear = {background.x, background.y, background.z, 1}}, [] {});
    }
    mUi.record(mCommands, *image);
    VkImageLayout layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    if (!mScreenshots.empty()) {
        mScreen = vk::Buffer(mDevice, uint64_t(4) * mSwapchain.width() * mSwapchain.height(),
                             vk::BufferUse::Readback, "screenshot");
        mCommands.transition(target, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Color,
                             vk::Stage::Transfer);
        layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        mCommands.copy(target, mScreen, 1);
        mCommands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    }
    const vk::Stage last =
        layout == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL ? vk::Stage::Transfer : vk::Stage::Color;
    mCommands.transition(target, layout, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, last, vk::Stage::Host);
    mCommands.submitAndWait();
    if (mModel && !mLightStats && mShownLight) mLightStats = mModel->light.readStats();
    if (!mScreenshots.empty()) saveScreenshots();
    if (!mSwapchain.present(*image)) mNeedsSwapchain = true;
    mTimes.add(secondsSince(start), mCommands.times());
    mFramesWanted = std::max(0, mFramesWanted - 1);
}

PanelFacts Viewer::facts() const {
    PanelFacts facts;
    facts.times = &mTimes;
    facts.device = mDevice.name();
    facts.isCapturing = mCapture.has_value();
    facts.notice = mNotice;
    facts.isFailure = mIsFailure;
    facts.task = mWorker.title();
    if (mBake) {
        facts.task = mBake->input().empty() ? "baking the built-in scene"
                                            : "baking " + mBake->input().filename().string();
        facts.task += ": " + mBake->progress().stage;
        facts.fraction = mBake->progress().fraction;
        facts.secondsLeft = mBake->progress().secondsLeft;
        facts.canCancel = true;
    }
    if (!mModel) return facts;
    facts.file = mModel->file.filename().string();
    facts.materials = materialNames(mModel->asset);
    for (const AssetPart& part : mModel->asset.parts) {
        facts.vertices += part.mesh.vertexCount();
        facts.triangles += part.mesh.triangleCount();
        for (const MaterialSet& set : part.sets) facts.transportBytes += bytesOf(set.transport);
    }
    facts.bakedShare = mModel->asset.provenance.bakedShare;
    facts.allCoefficients = uint32_t(6 * mModel->asset.faceSize * mModel->asset.faceSize);
    if (mLightStats) {
        facts.lightCoefficients = mLightStats->kept;
        facts.lightError = mLightStats->error;
    }
    return facts;
}

// Files

void Viewer::saveScreenshots() {
    for (const std::filesystem::path& file : std::exchange(mScreenshots, {})) {
        try {
            if (file.extension() == ".exr") {
                if (!mModel) throw Error("{}: nothing is shown yet", file.string());
                writeExr(file, mModel->view.read());
                const std::optional<std::string> command =
                    renderCommand(mState, mModel->file, int(mSwapchain.width()), int(mSwapchain.height()));
                if (command) spdlog::info("the same: {}", *command);
            } else
                writePng(file, screenImage(mScreen.map<uint8_t>(), int(mSwapchain.width()),
                                           int(mSwapchain.height()), mSwapchain.format()));
            tell(file.string() + " is written");
        } catch (const Error& why) {
            if (mOptions.exitFrame) throw; // nobody else will see it
            tell(why.what(), true);
        }
    }
    mScreen = {};
}

void Viewer::toggleCapture() {
    try {
        if (mCapture)
            endCapture();
        else
            beginCapture("relume-" + timeStamp() + ".json");
    } catch (const Error& why) {
        tell(why.what(), true);
    }
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
    mIsFailure = isFailure;
    mFramesWanted = std::max(mFramesWanted, 2);
}

} // namespace

void runViewer(const ViewerOptions& options) {
    Viewer viewer(options);
    viewer.run();
}

} // namespace relume
