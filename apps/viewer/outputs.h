// What is written of a session: screenshots, recordings, timing captures.
#pragma once

#include "apps/viewer/model.h"
#include "apps/viewer/recorder.h"
#include "apps/viewer/scene_state.h"
#include "apps/viewer/worker.h"
#include "engine/vk/timing_capture.h"

namespace relume {

// "relume-", the time to the millisecond, and this: a name in the folder that the program was started in.
std::string outputName(const std::string& ending);

// Writes a light file or session. Throws Error.
void writeJsonFile(const std::filesystem::path& file, const nlohmann::ordered_json& content);

class Outputs {
  public:
    using Tell = std::function<void(const std::string& words, bool isFailure)>;
    // `commands` draw the frames. Both must outlive this. `wake` as Worker's.
    Outputs(const vk::Device& device, vk::Commands& commands, Tell tell, std::function<void()> wake);

    // Of the next frame: .exr of the view, linear; else .png of the window.
    void wantScreenshot(const std::filesystem::path& file) { mScreenshots.push_back(file); }

    // The next frame will be written to a file.
    bool wantsFrame() const { return !mScreenshots.empty() || mRecorder; }

    // Every frame from now on, in a folder of its own; where ffmpeg is found, a video is made of them
    // afterwards. Throws Error.
    void beginRecording();
    void endRecording();
    // Tells what has become of videos, which are made beside the frames.
    void poll() { mWorker.apply(); }
    bool isSettled() const { return mWorker.isIdle(); }
    bool isRecording() const { return mRecorder != nullptr; }

    // What frames spend their time on. Throws Error.
    void beginCapture(const std::filesystem::path& file);
    void endCapture();
    // Null: none is under way.
    vk::TimingCapture* capture() { return mCapture ? &*mCapture : nullptr; }
    bool isCapturing() const { return mCapture.has_value(); }

    // Copies the window's image, in COLOR_ATTACHMENT_OPTIMAL, if it is wanted; then it is in
    // TRANSFER_SRC_OPTIMAL, and save() is due once this has ended.
    bool record(const vk::Image& window);
    // Writes it all; `model` is what the view shows, null: nothing yet; `fadesGround`:
    // SceneView::fadesGround(). Throws Error for what cannot be written, after the rest was.
    void save(const SceneState& state, const Model* model, bool fadesGround);

  private:
    void saveScreenshot(const std::filesystem::path& file, const Image& screen, const SceneState& state,
                        const Model* model, bool fadesGround);

    const vk::Device& mDevice;
    vk::Commands& mCommands;
    Tell mTell;
    std::optional<vk::TimingCapture> mCapture;
    std::filesystem::path mCaptureFile;
    std::unique_ptr<Recorder> mRecorder;
    std::vector<std::filesystem::path> mScreenshots;
    vk::Buffer mScreen; // the window's image
    vk::ImageOptions mWindow;
    Worker mWorker; // makes videos
};

} // namespace relume
