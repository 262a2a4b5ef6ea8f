// Writes screenshots, recordings and timing captures.
#pragma once

#include "apps/viewer/model.h"
#include "apps/viewer/recorder.h"
#include "apps/viewer/scene_state.h"
#include "apps/viewer/worker.h"
#include "engine/vk/timing_capture.h"

namespace relume {

// Returns "relume-", the time to the millisecond, and `ending`: a name that no file in the working folder
// has.
std::string outputName(const std::string& ending);

// Writes a light file or session; the name must end in .json, so that a slip does not replace another file.
void writeJsonFile(const std::filesystem::path& file, const nlohmann::ordered_json& content);

class Outputs {
  public:
    using Tell = std::function<void(const std::string& words, bool isFailure)>;
    // Keeps references to `device` and `commands`, which draw the frames. `wake`: see Worker.
    Outputs(const vk::Device& device, vk::Commands& commands, Tell tell, std::function<void()> wake);

    // Saves the next frame: the view's linear radiance for .exr, otherwise the window as .png.
    void wantScreenshot(const std::filesystem::path& file) { mScreenshots.push_back(file); }

    // Returns whether the next frame will be written to a file.
    bool wantsFrame() const { return !mScreenshots.empty() || mRecorder; }

    // Records every frame from now on to a new folder; endRecording() makes a video of them where ffmpeg is
    // found. Throws Error.
    void beginRecording();
    void endRecording();
    // Reports videos that have been finished on another thread.
    void poll() { mWorker.apply(); }
    bool isSettled() const { return mWorker.isIdle(); }
    // Ends what is under way and waits until all of it is written. Throws Error.
    void finish();
    bool isRecording() const { return mRecorder != nullptr; }

    // Captures the times of frames' passes. Throws Error.
    void beginCapture(const std::filesystem::path& file);
    void endCapture();
    // Returns the running capture, or null.
    vk::TimingCapture* capture() { return mCapture ? &*mCapture : nullptr; }
    bool isCapturing() const { return mCapture.has_value(); }

    // Copies the window's image, in COLOR_ATTACHMENT_OPTIMAL, if a file is wanted of it. Returns true if so:
    // the image is then in TRANSFER_SRC_OPTIMAL, and save() must be called after the submission.
    bool record(const vk::Image& window);
    // Writes all wanted files. `model` is the one in the view, null before the first; `ground` is from
    // SceneView::groundStyle(). Throws Error for files that cannot be written, after writing the others.
    void save(const SceneState& state, const Model* model, GroundStyle ground);

  private:
    void saveScreenshot(const std::filesystem::path& file, const Image& screen, const SceneState& state,
                        const Model* model, GroundStyle ground);

    const vk::Device& mDevice;
    vk::Commands& mCommands;
    Tell mTell;
    std::optional<vk::TimingCapture> mCapture;
    std::filesystem::path mCaptureFile;
    std::unique_ptr<Recorder> mRecorder;
    std::vector<std::filesystem::path> mScreenshots;
    vk::Buffer mScreen; // of the window's image
    vk::ImageOptions mWindow;
    Worker mWorker; // makes videos
};

} // namespace relume
