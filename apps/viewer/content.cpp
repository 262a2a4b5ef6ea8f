#include "apps/viewer/content.h"

#include "apps/viewer/opened_file.h"
#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/environment_file.h"
#include "engine/import/light_file.h"
#include "engine/import/scene.h"
#include "precompute/bake/sketch.h"

#include <algorithm>
#include <fmt/core.h>
#include <utility>

namespace relume {

namespace {

constexpr size_t kMostRecent = 12;

bool isSceneFile(const std::filesystem::path& input) { return extensionOf(input) == ".json"; }

// Reads a scene as `relume bake` does with the options of beginBake().
Scene readInput(const std::filesystem::path& input) {
    if (isSceneFile(input)) return readScene(input);
    const bool isBound = hasOwnMaterials(input);
    Scene scene{loadParts(input, UpAxis::Y, isBound ? std::nullopt : std::optional(kDefaultMaterial))};
    addGround(scene, {});
    return scene;
}

} // namespace

Content::Content(const vk::Device& device, const std::string& deviceSelect, LightState& light, Tell tell,
                 std::function<void()> wake)
    : mDevice(device), mDeviceSelect(deviceSelect), mLight(light), mTell(std::move(tell)), mModelWorker(wake),
      mLightWorker(std::move(wake)) {
    using Kind = EnvironmentChoice::Kind;
    mLight.environments = {{.kind = Kind::BuiltIn, .name = "sky"}, {.kind = Kind::DaySky, .name = "day sky"}};
}

void Content::open(const std::filesystem::path& file) {
    const FileKind kind = kindOf(file);
    // The built-in scene is only a stand-in, so its bakes are dropped.
    if (kind == FileKind::Bake || kind == FileKind::Bakeable) {
        std::erase_if(mNextBakes, [&](const Bake& bake) { return bake.input == mBuiltIn; });
        if (mBake && mBake->input() == mBuiltIn) cancelBake();
    }
    switch (kind) {
    case FileKind::Bake:
        load(file);
        showOpen(file);
        break;
    case FileKind::Bakeable:
        bake(file);
        showOpen(bakePath(file));
        break;
    case FileKind::Environment:
        mLight.environment = addEnvironment(mLight, file);
        mLight.file.reset();
        break;
    case FileKind::Light:
        openLight(file);
        break;
    case FileKind::Session:
        throw Error(fmt::format("{}: has become a session; open it again", file.string()));
    }
    remember(file);
}

void Content::openBuiltIn() {
    mBuiltIn = writeBuiltInScene();
    bake(mBuiltIn);
}

void Content::remember(const std::filesystem::path& file) {
    const std::filesystem::path whole = wholePath(file);
    std::erase(mRecent, whole);
    mRecent.insert(mRecent.begin(), whole);
    if (mRecent.size() > kMostRecent) mRecent.resize(kMostRecent);
}

bool Content::poll() {
    mModelWorker.apply();
    mLightWorker.apply();
    pollBake();
    readNextEnvironment();
    return std::exchange(mHasChanged, false);
}

// --- Models

void Content::load(const std::filesystem::path& bake, OnError onError) {
    if (mBake && mBake->output() == bake) mMustReload = false;
    mModelWorker.post(
        "reading " + bake.filename().string(),
        [this, bake]() -> Worker::Result {
            auto model = std::make_shared<Model>(mDevice, bake);
            return [this, model] { take(model); };
        },
        std::move(onError));
}

void Content::load(const std::filesystem::path& bake) {
    load(bake, [this](const std::string& why) { mTell(why, true); });
}

void Content::reload() {
    if (mShown) load(mShown->file);
    for (const std::shared_ptr<Model>& model : mModels)
        if (model != mShown) load(model->file);
}

std::vector<std::shared_ptr<Model>>::iterator Content::find(const std::filesystem::path& file) {
    return std::ranges::find_if(
        mModels, [whole = wholePath(file)](const auto& model) { return wholePath(model->file) == whole; });
}

void Content::showOpen(const std::filesystem::path& file) {
    const auto open = find(file);
    if (open == mModels.end()) return;
    mShown = *open;
    mHasChanged = true;
}

void Content::take(std::shared_ptr<Model> model) {
    const auto same = find(model->file);
    // Show a reloaded model only if it was shown before; the user may be looking at another.
    const bool isShown = !mShown || same == mModels.end() || *same == mShown;
    if (same != mModels.end())
        *same = model;
    else
        mModels.push_back(model);
    if (isShown) mShown = std::move(model);
    mHasChanged = true;
}

void Content::close(size_t model) {
    if (mModels.size() < 2) return;
    const bool wasShown = mShown == mModels.at(model);
    if (mBake && mBake->output() == mModels[model]->file) cancelBake();
    mModels.erase(mModels.begin() + std::ptrdiff_t(model));
    if (wasShown) mShown = mModels[std::min(model, mModels.size() - 1)];
    mHasChanged = true;
}

// --- Bakes

void Content::bake(const std::filesystem::path& input) {
    const Bake bake{input, bakePath(input)};
    mInputs[bake.output] = wholePath(input);
    const auto isSame = [&](const Bake& other) { return other.output == bake.output; };
    // It is not begun again while it runs, or is the next and its sketch is being read.
    if (mBake ? mBake->output() == bake.output : !mNextBakes.empty() && isSame(mNextBakes.front())) return;
    if (mBake) { // to be resumed later
        mNextBakes.push_back({mBake->input(), mBake->output()});
        cancelBake();
    }
    std::erase_if(mNextBakes, isSame);
    std::error_code failure;
    const bool isThere = std::filesystem::exists(bake.output, failure);
    if (!isThere || std::filesystem::exists(bake.output.string() + ".checkpoint", failure))
        mNextBakes.push_front(bake);
    if (!isThere) return sketch(bake);
    load(bake.output, [this, bake](const std::string& why) {
        mTell(why + "; it is baked again", false);
        std::error_code ignored;
        std::filesystem::remove(bake.output, ignored);
        std::erase_if(mNextBakes, [&](const Bake& other) { return other.output == bake.output; });
        mNextBakes.push_front(bake);
    });
}

// Shows a sketch until there is a bake. Errors are only logged, since the bake reports them.
void Content::sketch(const Bake& bake) {
    mModelWorker.post(
        "reading " + bake.input.filename().string(),
        [this, bake]() -> Worker::Result {
            auto model =
                std::make_shared<Model>(mDevice, bake.output, makeSketch(mDevice, readInput(bake.input)));
            return [this, model] { take(model); };
        },
        [](const std::string& why) { log(LogLevel::Debug, "no sketch: " + why); });
}

std::filesystem::path Content::inputOf(const std::filesystem::path& bake) const {
    const auto known = mInputs.find(bake);
    return known == mInputs.end() ? std::filesystem::path() : known->second;
}

void Content::cancelBake() {
    mMustReload = false;
    if (!mBake) return;
    mBake->stop();
    mStopping.push_back(std::move(mBake));
}

void Content::beginBake(const Bake& bake) {
    std::vector<std::string> options;
    if (!isSceneFile(bake.input)) options = {"--ground"};
    if (!mDeviceSelect.empty()) options.insert(options.end(), {"--device", mDeviceSelect});
    try {
        mBake = std::make_unique<BakeProcess>(bake.input, bake.output, options);
    } catch (const Error& why) {
        mTell(why.what(), true);
    }
}

void Content::pollBake() {
    std::erase_if(mStopping, [](const auto& bake) {
        bake->poll();
        return !bake->isRunning();
    });
    // A bake takes all processor cores, so it waits until its mesh has been read to be shown.
    const bool isFree = !mBake && mStopping.empty() && mModelWorker.isIdle();
    if (isFree && !mNextBakes.empty()) {
        const Bake next = mNextBakes.front();
        mNextBakes.pop_front();
        beginBake(next);
        mHasChanged = true;
    }
    if (!mBake) return;
    const BakeProgress before = mBake->progress();
    mMustReload |= mBake->poll();
    mHasChanged |= mBake->progress() != before;
    if (mMustReload && mModelWorker.isIdle()) load(mBake->output());
    if (mBake->isRunning() || mMustReload) return;
    if (!mBake->failure().empty()) mTell(mBake->failure(), true);
    mBake.reset();
    mHasChanged = true;
}

// --- Light

// Reads the chosen environment first.
void Content::readNextEnvironment() {
    const auto wants = [](const EnvironmentChoice& choice) {
        return !choice.isRead && choice.kind != EnvironmentChoice::Kind::DaySky;
    };
    std::vector<EnvironmentChoice>& choices = mLight.environments;
    EnvironmentChoice& chosen = choices[mLight.environment];
    // The chosen one could not be read before; try again.
    if (!mLight.isReady() && mLightWorker.isIdle()) chosen.isRead = false;
    if (wants(chosen)) {
        readEnvironment(mLight.environment);
    } else if (const auto next = std::ranges::find_if(choices, wants); next != choices.end() && isSettled())
        readEnvironment(size_t(next - choices.begin()));
}

void Content::readEnvironment(size_t number) {
    EnvironmentChoice& choice = mLight.environments[number];
    choice.isRead = true;
    mLightWorker.post(
        "reading " + choice.name,
        [this, number, file = choice.file]() -> Worker::Result {
            Environment whole = file.empty() ? makeSky() : relume::readEnvironment(file);
            auto map = std::make_shared<const Environment>(prepareForSampling(whole));
            auto picture = makePicture(file.empty() ? makeSky(kSkyPictureColumns) : std::move(whole));
            return [this, number, map, picture] {
                mLight.environments[number].map = map;
                mLight.environments[number].picture = picture;
                mHasChanged = true;
            };
        },
        [this, number](const std::string& why) {
            mTell(why, true);
            if (mLight.environment == number) mLight.environment = 0;
        });
}

void Content::openLight(const std::filesystem::path& file) {
    mLightWorker.post(
        "reading " + file.filename().string(),
        [this, file]() -> Worker::Result {
            auto light = std::make_shared<MovingLight>(readLight(file));
            light->keepPictures();
            return [this, light, file] {
                mLight.file = light;
                mLight.fileName = file;
                mLight.seconds = 0;
                mHasChanged = true;
            };
        },
        [this](const std::string& why) { mTell(why, true); });
}

Task Content::task() const {
    if (!mBake && !mModelWorker.isIdle()) return {.title = mModelWorker.title()};
    if (!mBake) return {.title = !mNextBakes.empty() ? "waiting for the bake before" : mLightWorker.title()};
    return {.title = "baking " + mBake->input().filename().string() + ": " + mBake->progress().stage,
            .fraction = mBake->progress().fraction,
            .secondsLeft = mBake->progress().secondsLeft,
            .canCancel = true};
}

} // namespace relume
