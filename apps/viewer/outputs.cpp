#include "apps/viewer/outputs.h"

#include "apps/viewer/opened_file.h"
#include "apps/viewer/screenshot.h"
#include "apps/viewer/video.h"
#include "engine/base/error.h"
#include "engine/base/error_message.h"
#include "engine/base/file.h"
#include "engine/import/image_file.h"
#include "engine/import/timing_file.h"

#include <chrono>
#include <ctime>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <utility>

namespace relume {

std::string outputName(const std::string& ending) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
    const std::time_t seconds = milliseconds / 1000;
    std::tm local{};
    localtime_r(&seconds, &local);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
    const std::string stem = fmt::format("relume-{}-{:03}", text, milliseconds % 1000);
    std::string name = stem + ending;
    std::error_code failure;
    for (int copy = 2; std::filesystem::exists(name, failure); copy++)
        name = fmt::format("{}-{}{}", stem, copy, ending);
    return name;
}

void writeJsonFile(const std::filesystem::path& file, const nlohmann::ordered_json& content) {
    if (extensionOf(file) != ".json")
        throw Error(fmt::format("{}: expected a name ending in .json", file.string()));
    try {
        writeFileAtomically(file, content.dump(2) + "\n");
    } catch (const nlohmann::json::exception&) {
        throw Error(fmt::format("{}: JSON is UTF-8, and the name of a file in it is not; rename that",
                                file.string()));
    }
}

Outputs::Outputs(const vk::Device& device, vk::Commands& commands, Tell tell, std::function<void()> wake)
    : mDevice(device), mCommands(commands), mTell(std::move(tell)), mWorker(std::move(wake)) {}

void Outputs::beginRecording() {
    mRecorder = std::make_unique<Recorder>(outputName(""));
    mTell("recording; Ctrl + F12 ends it", false);
}

void Outputs::endRecording() {
    const std::unique_ptr<Recorder> ended = std::move(mRecorder);
    ended->finish();
    const std::filesystem::path& folder = ended->folder();
    mTell(fmt::format("{}: {} images", folder.string(), ended->frames()), false);
    mWorker.post(
        "making a video",
        [this, folder]() -> Worker::Result {
            const auto video = encodeVideo(folder, Recorder::kFramesPerSecond);
            return [this, folder, video] {
                if (!video) return;
                mTell(fmt::format("{} is made of the images in {}", video->string(), folder.string()), false);
            };
        },
        [this](const std::string& why) { mTell(why, true); });
}

void Outputs::finish() {
    if (isRecording()) endRecording();
    if (isCapturing()) endCapture();
    mWorker.wait();
    mWorker.apply();
}

void Outputs::beginCapture(const std::filesystem::path& file) {
    expectTimingFile(file);
    mCaptureFile = file;
    mCapture.emplace();
    mCapture->attach(mDevice);
    mCommands.setCapture(&*mCapture);
    mTell("capturing times; F9 ends it", false);
}

void Outputs::endCapture() {
    mCommands.setCapture(nullptr);
    const TimingTrace trace = mCapture->trace();
    mCapture.reset();
    writeTimings(mCaptureFile, trace);
    mTell(mCaptureFile.string() + " is written", false);
}

bool Outputs::record(const vk::Image& window) {
    if (mScreenshots.empty() && !mRecorder) return false;
    mWindow = window.options();
    const uint64_t bytes = uint64_t(4) * mWindow.width * mWindow.height;
    if (mScreen.bytes() != bytes) mScreen = vk::Buffer(mDevice, bytes, vk::BufferUse::Readback, "screenshot");
    mCommands.transition(window, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, vk::Stage::Color, vk::Stage::Transfer);
    mCommands.copy(window, mScreen, 1);
    mCommands.barrier(vk::Stage::Transfer, vk::Stage::Host);
    return true;
}

void Outputs::save(const SceneState& state, const Model* model, GroundStyle ground) {
    const Image screen =
        screenImage(mScreen.map<uint8_t>(), int(mWindow.width), int(mWindow.height), mWindow.format);
    std::string failure;
    for (const std::filesystem::path& file : std::exchange(mScreenshots, {})) {
        try {
            saveScreenshot(file, screen, state, model, ground);
            mTell(file.string() + " is written", false);
        } catch (const std::exception& why) {
            failure = errorMessage(why);
        }
    }
    if (!failure.empty()) throw Error(failure);
    if (mRecorder) mRecorder->add(screen);
}

void Outputs::saveScreenshot(const std::filesystem::path& file, const Image& screen, const SceneState& state,
                             const Model* model, GroundStyle ground) {
    if (file.extension() != ".exr") return writePng(file, screen);
    if (!model) throw Error(fmt::format("{}: nothing is shown yet", file.string()));
    writeExr(file, model->view.read());
    if (state.inspect != Inspect::Off || model->isSketch) return; // no command draws these
    std::filesystem::path light = file;
    light.replace_extension(".light.json");
    if (needsLightFile(state.light)) writeJsonFile(light, lightFileOf(state.light));
    const auto command = [&](Drawn drawn) {
        nlohmann::ordered_json options = renderOptions(state, ground, drawn);
        if (needsLightFile(state.light)) options["light"] = light.string();
        return renderCommand(options, model->file, int(mWindow.width), int(mWindow.height), drawn);
    };
    spdlog::info("as a picture: {}", command(Drawn::Picture));
    spdlog::info("the same: {}", command(Drawn::Radiance));
}

} // namespace relume
