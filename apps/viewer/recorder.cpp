#include "apps/viewer/recorder.h"

#include "engine/base/error.h"
#include "engine/import/image_file.h"

#include <fmt/core.h>

namespace relume {

namespace {

constexpr size_t kMostWaiting = 8;

} // namespace

Recorder::Recorder(std::filesystem::path folder) : mFolder(std::move(folder)), mWorker([] {}) {
    std::error_code failure;
    if (!std::filesystem::create_directories(mFolder, failure))
        throw Error(fmt::format("{}: cannot be made: {}", mFolder.string(),
                                failure ? failure.message() : "it is there"));
}

void Recorder::add(Image frame) {
    const std::filesystem::path file = mFolder / fmt::format("frame_{:04}.png", ++mFrames);
    mWorker.apply();
    if (mWaiting >= kMostWaiting) {
        try {
            writePng(file, frame);
        } catch (const Error& why) {
            mFailure = why.what();
        }
        return;
    }
    mWaiting++;
    mWorker.post(
        "writing " + file.filename().string(),
        [this, file, image = std::make_shared<Image>(std::move(frame))]() -> Worker::Result {
            writePng(file, *image);
            return [this] { mWaiting--; };
        },
        [this](const std::string& why) {
            mWaiting--;
            mFailure = why;
        });
}

void Recorder::finish() {
    mWorker.wait();
    mWorker.apply();
    if (!mFailure.empty()) throw Error(mFailure);
}

} // namespace relume
