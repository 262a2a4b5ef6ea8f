#include "apps/viewer/viewer.h"

#include "apps/viewer/controls.h"
#include "apps/viewer/files.h"
#include "apps/viewer/frames.h"
#include "apps/viewer/history.h"
#include "apps/viewer/opened_file.h"
#include "apps/viewer/preferences.h"
#include "apps/viewer/script.h"
#include "apps/viewer/settings.h"
#include "apps/viewer/shader_compiler.h"
#include "apps/viewer/user_folders.h"
#include "engine/base/error.h"
#include "engine/base/interrupt.h"
#include "engine/import/image_file.h"
#include "engine/render/contact_sheet.h"

#include <algorithm>
#include <chrono>
#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace relume {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFramesAfterInput = 3; // until panels have taken it in

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

// Sessions that nobody watches are the same whatever was done before.
bool hasPreferences(const ViewerOptions& options) { return options.script.empty() && !options.exitFrame; }

ivec2 firstSize(const ViewerOptions& options, const Preferences& preferences) {
    return options.size.value_or(preferences.size.value_or(ivec2(1280, 720)));
}

// The loop: takes input, lets time pass, and draws frames where something has changed.
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
    void execute(Command command);
    void execute(const PanelRequests& requests);
    std::optional<RayHit> hitUnderCursor() const;
    void pickPart();
    void focus();
    void askWhy();
    void reloadShaders();
    void saveLight(const std::filesystem::path& file);
    void saveSession(const std::filesystem::path& file);
    void makeSheet(const std::filesystem::path& file);
    void toggleCapture();
    void toggleRecording();

    void poll();
    void keepHistory();
    void updateTitle();
    void expectSomething() const;
    bool wantsFrame() const;
    bool moves() const { return mState.turns || mState.light.plays; }
    double waitSeconds() const;

    const Model* model() const { return mContent.shown().get(); }
    // Whether a model is shown, from somewhere.
    bool hasView() const { return model() && mState.orbit; }

    ViewerOptions mOptions;
    Preferences mPreferences;
    Window mWindow;
    vk::Device mDevice;
    Notice mNotice;
    SceneState mState;
    History mHistory;
    Controls mControls;
    LampHandles mLamps;
    std::optional<Script> mScript;
    Content mContent;
    Files mFiles;
    SceneView mView;
    Frames mFrames;
    std::string mTitle;
    int mSettledFrames = 0;
    Clock::time_point mLastFrame = Clock::now();
    Worker mWorker{Window::wake}; // last: its work uses all of the above
};

Viewer::Viewer(const ViewerOptions& options)
    : mOptions(options), mPreferences(hasPreferences(options) ? readPreferences() : Preferences{}),
      mWindow("Relume", firstSize(options, mPreferences)), mDevice(deviceOptions(options, mWindow)),
      mContent(
          mDevice, options.device.select, mState.light,
          [this](const std::string& words, bool isFailure) { mNotice.tell(words, isFailure); }, Window::wake),
      mFiles(mState, mContent),
      mView(mDevice, Window::wake,
            [this](const std::string& words, bool isFailure) { mNotice.tell(words, isFailure); }),
      mFrames(mWindow, mDevice, {mState, mContent, mView, mLamps, mNotice}, options.waitsForDisplay) {
    mFrames.want(kFramesAfterInput);
    for (const auto& [name, value] : mPreferences.settings.items()) {
        // Versions without backgrounds stored the exposure even if the user had never set it.
        if (name == "exposure" && !mPreferences.settings.contains("background")) continue;
        try {
            applySetting(mState, name, value, nullptr);
        } catch (const std::exception& why) {
            spdlog::debug("a remembered setting is left out: {}", why.what());
        }
    }
    mState.waitsForDisplay &= options.waitsForDisplay;
    mContent.setRecent(mPreferences.recent);
    for (const std::filesystem::path& file : mPreferences.environments) addEnvironment(mState.light, file);
    if (!options.script.empty()) mScript.emplace(options.script);
    if (!options.timings.empty()) mFrames.outputs().beginCapture(options.timings);
    bool hasModel = false;
    for (const std::filesystem::path& file : options.files) {
        if (!std::filesystem::exists(file))
            throw Error(fmt::format("{}: there is no such file", file.string()));
        const FileKind kind = kindOf(file);
        hasModel |= kind != FileKind::Environment && kind != FileKind::Light;
        mFiles.open(file);
    }
    if (!hasModel) mContent.openBuiltIn();
}

Viewer::~Viewer() {
    mDevice.savePipelineCache();
    if (!hasPreferences(mOptions)) return;
    // A window is made as large as this times its scale.
    if (!mWindow.isFullScreen()) mPreferences.size = ivec2(vec2(mWindow.size()) / mWindow.scale());
    mPreferences.recent = mContent.recent();
    mPreferences.environments.clear();
    for (const EnvironmentChoice& choice : mState.light.environments)
        if (choice.kind == EnvironmentChoice::Kind::File && choice.map)
            mPreferences.environments.push_back(choice.file);
    nlohmann::json kept = rememberedSettings(mState);
    if (!mOptions.waitsForDisplay) { // for this time only
        const auto before = mPreferences.settings.find("vsync");
        kept["vsync"] = before != mPreferences.settings.end() ? *before : nlohmann::json(true);
    }
    mPreferences.settings = std::move(kept);
    writePreferences(mPreferences);
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
    mFrames.outputs().wantScreenshot(file);
}

void Viewer::takeEvents() {
    const UiWants wants = Ui::wants();
    for (const InputEvent& event : mWindow.takeEvents()) {
        mFrames.want(kFramesAfterInput);
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
    if (hasView() && isOfMouse && (mState.showsPanels || mLamps.isDragging()) &&
        mLamps.take(event, mState.light, mState.orbit->camera(), model()->bounds, mWindow.size()))
        return;
    execute(mControls.take(event, mState, mWindow.size(), model() ? &model()->bounds : nullptr));
}

void Viewer::open(const std::filesystem::path& file) {
    attempt(mNotice, [&] { mFiles.open(file); });
}

void Viewer::execute(Command command) {
    switch (command) {
    case Command::None:
        return;
    case Command::Undo:
        if (!mHistory.undo(mState)) mNotice.tell("nothing is left to undo");
        return;
    case Command::Redo:
        if (!mHistory.redo(mState)) mNotice.tell("nothing is left to redo");
        return;
    case Command::Pick:
        return pickPart();
    case Command::Focus:
        return focus();
    case Command::ExplainVertex:
        return askWhy();
    case Command::Screenshot:
        for (const char* extension : {".png", ".exr"})
            mFrames.outputs().wantScreenshot(outputName(extension));
        return;
    case Command::SaveSession:
        return saveSession(outputName(".session.json"));
    case Command::Sheet:
        return makeSheet(outputName("-sheet.png"));
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
        if (model()) bindNextMaterial(mState, materialNames(model()->asset));
        return;
    case Command::NextModel: {
        const auto& models = mContent.models();
        const auto shown = std::ranges::find(models, mContent.shown());
        if (shown != models.end()) mContent.show(size_t(shown - models.begin() + 1) % models.size());
        return;
    }
    case Command::FewerTerms:
        if (model()) addTerms(mState, -1, termsOf(*model()));
        return;
    case Command::MoreTerms:
        if (model()) addTerms(mState, 1, termsOf(*model()));
        return;
    case Command::Quit:
        return mWindow.close();
    }
}

void Viewer::execute(const PanelRequests& requests) {
    if (requests.cancelsBake) mContent.cancelBake();
    if (requests.takesScreenshot) execute(Command::Screenshot);
    if (requests.togglesCapture) toggleCapture();
    if (requests.togglesRecording) toggleRecording();
    if (requests.resetsView) mState.orbit.reset();
    if (requests.dismissesNotice) mNotice.clear();
    if (requests.reloadsShaders) reloadShaders();
    if (requests.undoes) execute(Command::Undo);
    if (requests.redoes) execute(Command::Redo);
    if (requests.savesLight) saveLight(*requests.savesLight);
    if (requests.savesSession) saveSession(*requests.savesSession);
    if (requests.opens) open(*requests.opens);
    if (requests.shows) mContent.show(*requests.shows);
    if (requests.closes) mContent.close(*requests.closes);
    if (!mState.showsExplanation) mFrames.pictures().stopAsking();
}

std::optional<RayHit> Viewer::hitUnderCursor() const {
    if (!hasView()) return std::nullopt;
    return pick(*model(), mState.orbit->camera(), mControls.cursor(), mWindow.size());
}

void Viewer::pickPart() {
    mState.picked.reset();
    if (const auto hit = hitUnderCursor()) mState.picked = hit->mesh;
}

void Viewer::focus() {
    if (const auto hit = hitUnderCursor()) {
        // From the same side, with the point in the middle; half as far away.
        mState.orbit->target = positionOf(*model(), *hit);
        mState.orbit->distance = std::max(0.5f * mState.orbit->distance, 0.05f * model()->bounds.radius());
    }
}

void Viewer::askWhy() {
    if (!hasView()) return;
    if (model()->isSketch) return mNotice.tell("nothing is baked yet that could say why");
    const auto hit = hitUnderCursor();
    if (!hit) {
        mState.showsExplanation = false;
        return mFrames.pictures().stopAsking();
    }
    const uvec3 corners = model()->asset.parts[hit->mesh].mesh.triangles[hit->triangle];
    int nearest = 0;
    for (int c = 1; c < 3; c++)
        if (hit->weights[c] > hit->weights[nearest]) nearest = c;
    mFrames.pictures().ask(*model(), hit->mesh, corners[nearest]);
    mState.showsExplanation = true;
}

// Beside the frames; what is shown stays until all of it is there.
void Viewer::reloadShaders() {
    mWorker.post(
        "building shaders",
        [this]() -> Worker::Result {
            const size_t changed = relume::reloadShaders(mDevice, shaderFolder());
            return [this, changed] {
                mNotice.tell(changed > 0 ? fmt::format("{} shaders are new", changed)
                                         : "no shader has changed");
                if (changed == 0) return;
                mFrames.remakePrograms();
                mView.remakePrograms();
                mContent.reload();
            };
        },
        [this](const std::string& why) { mNotice.tell(why, true); });
}

void Viewer::saveLight(const std::filesystem::path& file) {
    attempt(mNotice, [&] { mNotice.tell(mFiles.saveLight(file)); });
}

void Viewer::saveSession(const std::filesystem::path& file) {
    attempt(mNotice, [&] {
        mNotice.tell(
            mFiles.saveSession(file, mView.drawn(mState), mView.groundStyle(mState), mWindow.size()));
    });
}

// Beside the frames. Lamps, strokes and a light file are part of the look, not of the lights to choose from.
void Viewer::makeSheet(const std::filesystem::path& file) {
    if (!hasView()) return;
    if (model()->isSketch) return mNotice.tell("nothing is baked yet to make a sheet of");
    std::vector<SheetColumn> columns;
    LightState one = mState.light;
    one.file.reset();
    one.lamps.clear();
    one.strokes.clear();
    for (one.environment = 0; one.environment < one.environments.size(); one.environment++)
        if (one.isReady()) columns.push_back({lightOf(one), glm::radians(one.rotation)});
    mNotice.tell("a contact sheet is being drawn");
    mWorker.post(
        "drawing a contact sheet",
        [this, file, model = mContent.shown(), columns = std::move(columns),
         camera = mState.orbit->camera()]() -> Worker::Result {
            const std::vector<SheetRow> rows = sheetRows(model->asset, model->file.stem().string());
            ContactSheet sheet(columns, rows.size(), {});
            sheet.add(mDevice, model->asset, rows, camera);
            writePng(file, sheet.image());
            return [this, file] { mNotice.tell(fmt::format("{} is written", file.string())); };
        },
        [this](const std::string& why) { mNotice.tell(why, true); });
}

void Viewer::toggleRecording() {
    Outputs& outputs = mFrames.outputs();
    attempt(mNotice, [&] { outputs.isRecording() ? outputs.endRecording() : outputs.beginRecording(); });
}

void Viewer::toggleCapture() {
    Outputs& outputs = mFrames.outputs();
    attempt(mNotice, [&] {
        outputs.isCapturing() ? outputs.endCapture() : outputs.beginCapture(outputName(".json"));
    });
}

void Viewer::set(const std::string& name, const nlohmann::json& value) {
    mFrames.want(kFramesAfterInput);
    if (name == "environment") {
        mState.light.environment =
            value == "sky" ? 0 : addEnvironment(mState.light, value.get<std::string>());
        mState.light.file.reset();
    } else
        applySetting(mState, name, value, hasView() ? &model()->bounds : nullptr);
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
        if (mWindow.takeDamage()) mFrames.want(1);
        if (!wantsFrame()) {
            mLastFrame = Clock::now();
            continue;
        }
        if (mOptions.exitFrame && isSettled()) {
            mSettledFrames++;
            if (mSettledFrames == *mOptions.exitFrame && !mOptions.screenshot.empty())
                mFrames.outputs().wantScreenshot(mOptions.screenshot);
        }
        const Clock::time_point now = Clock::now();
        const double seconds = std::chrono::duration<double>(now - std::exchange(mLastFrame, now)).count();
        // Nobody sees what is told where the window ends by itself.
        if (const auto requests = mFrames.draw(seconds, mOptions.exitFrame.has_value())) execute(*requests);
        if (mOptions.exitFrame && mSettledFrames >= *mOptions.exitFrame) break;
    }
    mFrames.outputs().finish();
}

void Viewer::poll() {
    if (mNotice.update()) mFrames.want(2);
    mWorker.apply();
    if (mContent.poll()) mFrames.want(kFramesAfterInput);
    if (mView.poll()) mFrames.want(1);
    if (mFrames.pictures().poll()) mFrames.want(1);
    mFrames.outputs().poll();
    if (model()) mFiles.resumeSession();
    keepHistory();
    updateTitle();
}

// A drag is one step, and so is what plays until it pauses.
void Viewer::keepHistory() {
    if (mControls.isDragging() || mLamps.isDragging() || Ui::isItemHeld() || moves()) return;
    mHistory.keep(mState);
}

void Viewer::updateTitle() {
    if (!model()) return;
    const std::string name = model()->file.filename().string();
    std::string title = (name.starts_with(kBuiltInScene) ? kBuiltInScene : name) + " - Relume";
    if (!mState.showsPanels) title += " (Tab shows the panels)";
    if (title == mTitle) return;
    mTitle = title;
    mWindow.setTitle(title);
}

// Nobody is there to open something else.
void Viewer::expectSomething() const {
    const bool isReplayed = mOptions.exitFrame || (mScript && mScript->isWaiting());
    if (isReplayed && !model() && mNotice.isFailure() && mContent.isSettled()) throw Error(mNotice.words());
}

bool Viewer::wantsFrame() const {
    return mFrames.areWanted() || mNotice.hasNews() || moves() || mFrames.outputs().isRecording() ||
           mOptions.exitFrame || (mScript && !mScript->hasEnded() && !mScript->isWaiting());
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
    return model() && !mFrames.areWanted() && !mNotice.hasNews() && mContent.isSettled() &&
           mView.isSettled(mState) && mFrames.pictures().isSettled() && mFrames.outputs().isSettled() &&
           mWorker.isIdle();
}

} // namespace

void runViewer(const ViewerOptions& options) {
    Viewer viewer(options);
    viewer.run();
}

} // namespace relume
