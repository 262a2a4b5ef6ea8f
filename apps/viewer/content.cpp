#include "apps/viewer/content.h"

#include "apps/viewer/opened_file.h"
#include "engine/base/error.h"
#include "engine/light/light_file.h"

#include <algorithm>
#include <utility>

namespace relume {

namespace {

constexpr size_t kMostRecent = 12;

} // namespace

Content::Content(const vk::Device& device, const std::string& deviceSelect, LightState& light, Tell tell,
                 std::function<void()> wake)
    : mDevice(device), mDeviceSelect(deviceSelect), mLight(light), mTell(std::move(tell)),
      mWorker(std::move(wake)) {
    using Kind = EnvironmentChoice::Kind;
    mLight.environments = {{.kind = Kind::BuiltIn, .name = "sky"}, {.kind = Kind::DaySky, .name = "day sky"}};
}

void Content::open(const std::filesystem::path& file) {
    switch (kindOf(file)) {
    case FileKind::Bake:
        load(file);
        break;
    case FileKind::Bakeable:
        bake(file);
        break;
    case FileKind::Environment:
        mLight.environment = addEnvironment(file);
        mLight.file.reset();
        break;
    case FileKind::Light:
        openLight(file);
        break;
    }
    remember(file);
}

void Content::openBuiltIn() { bake(""); }

void Content::remember(const std::filesystem::path& file) {
    const std::filesystem::path whole = std::filesystem::absolute(file).lexically_normal();
    std::erase(mRecent, whole);
    mRecent.insert(mRecent.begin(), whole);
    if (mRecent.size() > kMostRecent) mRecent.resize(kMostRecent);
}

bool Content::poll() {
    mWorker.apply();
    pollBake();
    readNextEnvironment();
    return std::exchange(mHasChanged, false);
}

// Models

void Content::load(const std::filesystem::path& bake) {
    mMustReload = false;
    mWorker.post(
        "reading " + bake.filename().string(),
        [this, bake]() -> Worker::Result {
            auto model = std::make_shared<Model>(mDevice, bake);
            return [this, model] { take(model); };
        },
        [this](const std::string& why) { mTell(why, true); });
}

void Content::reload() {
    if (mShown) load(mShown->file);
}

void Content::take(std::shared_ptr<Model> model) {
    const auto same = std::ranges::find_if(mModels, [&](const auto& m) { return m->file == model->file; });
    if (same != mModels.end())
        *same = model;
    else
        mModels.push_back(model);
    mShown = std::move(model);
    mHasChanged = true;
}

void Content::close(size_t model) {
    if (mModels.size() < 2) return;
    const bool wasShown = mShown == mModels.at(model);
    mModels.erase(mModels.begin() + std::ptrdiff_t(model));
    if (wasShown) mShown = mModels[std::min(model, mModels.size() - 1)];
    mHasChanged = true;
}

// Bakes

void Content::bake(const std::filesystem::path& input) {
    const std::filesystem::path output = bakePath(input);
    cancelBake();
    const bool isThere = std::filesystem::exists(output);
    if (isThere) load(output);
    if (!isThere || std::filesystem::exists(output.string() + ".checkpoint")) mNextBake = {input, output};
}

void Content::cancelBake() {
    mNextBake.reset();
    mMustReload = false;
    if (!mBake) return;
    mBake->stop();
    mStopping.push_back(std::move(mBake));
}

void Content::pollBake() {
    std::erase_if(mStopping, [](const auto& bake) {
        bake->poll();
        return !bake->isRunning();
    });
    if (mNextBake && mStopping.empty()) {
        const Bake next = *std::exchange(mNextBake, std::nullopt);
        std::vector<std::string> options;
        if (next.input.extension() != ".json") options = {"--ground", "--ground-tessellation", "64"};
        if (!mDeviceSelect.empty()) options.insert(options.end(), {"--device", mDeviceSelect});
        try {
            mBake = std::make_unique<BakeProcess>(next.input, next.output, options);
        } catch (const Error& why) {
            mTell(why.what(), true);
        }
        mHasChanged = true;
    }
    if (!mBake) return;
    const BakeProgress before = mBake->progress();
    mMustReload |= mBake->poll();
    mHasChanged |= mBake->progress() != before;
    if (mMustReload && mWorker.isIdle()) load(mBake->output());
    if (mBake->isRunning() || mMustReload) return;
    if (!mBake->failure().empty()) mTell(mBake->failure(), true);
    mBake.reset();
    mHasChanged = true;
}

// Light

size_t Content::addEnvironment(const std::filesystem::path& file) {
    std::vector<EnvironmentChoice>& choices = mLight.environments;
    const std::filesystem::path whole = std::filesystem::absolute(file).lexically_normal();
    const auto known = std::ranges::find(choices, whole, &EnvironmentChoice::file);
    const auto number = size_t(known - choices.begin());
    if (known == choices.end())
        choices.push_back({EnvironmentChoice::Kind::File, file.stem().string(), whole});
    return number;
}

// The chosen one first.
void Content::readNextEnvironment() {
    const auto wants = [](const EnvironmentChoice& choice) {
        return !choice.isRead && choice.kind != EnvironmentChoice::Kind::DaySky;
    };
    std::vector<EnvironmentChoice>& choices = mLight.environments;
    EnvironmentChoice& chosen = choices[mLight.environment];
    // It could not be read before: perhaps now.
    if (!mLight.isReady() && mWorker.isIdle()) chosen.isRead = false;
    if (wants(chosen)) {
        readEnvironment(mLight.environment);
    } else if (const auto next = std::ranges::find_if(choices, wants); next != choices.end() && isSettled())
        readEnvironment(size_t(next - choices.begin()));
}

void Content::readEnvironment(size_t number) {
    EnvironmentChoice& choice = mLight.environments[number];
    choice.isRead = true;
    mWorker.post(
        "reading " + choice.name,
        [this, number, file = choice.file]() -> Worker::Result {
            auto map = std::make_shared<const Environment>(
                prepareForSampling(file.empty() ? makeSky() : relume::readEnvironment(file)));
            return [this, number, map] {
                mLight.environments[number].map = map;
                mHasChanged = true;
            };
        },
        [this, number](const std::string& why) {
            mTell(why, true);
            if (mLight.environment == number) mLight.environment = 0;
        });
}

void Content::openLight(const std::filesystem::path& file) {
    mWorker.post(
        "reading " + file.filename().string(),
        [this, file]() -> Worker::Result {
            auto light = std::make_shared<MovingLight>(readLight(file));
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
    if (!mBake) return {.title = mNextBake ? "waiting for the bake before" : mWorker.title()};
    const std::filesystem::path& input = mBake->input();
    return {.title = (input.empty() ? "baking the built-in scene" : "baking " + input.filename().string()) +
                     ": " + mBake->progress().stage,
            .fraction = mBake->progress().fraction,
            .secondsLeft = mBake->progress().secondsLeft,
            .canCancel = true};
}

} // namespace relume
