// Records the window frame by frame as numbered images.
#pragma once

#include "apps/viewer/worker.h"
#include "engine/image/image.h"

#include <filesystem>

namespace relume {

class Recorder {
  public:
    // Frame rate in recorded time, however long frames take.
    static constexpr double kFramesPerSecond = 30;

    // Makes the folder, which must not exist. Throws Error.
    explicit Recorder(std::filesystem::path folder);

    // Writes the next frame (frame_0001.png …) in the background, or before returning if too many are
    // waiting.
    void add(Image frame);
    // Waits until all frames are written. Throws Error if one could not be.
    void finish();

    const std::filesystem::path& folder() const { return mFolder; }
    int frames() const { return mFrames; }

  private:
    std::filesystem::path mFolder;
    int mFrames = 0;
    size_t mWaiting = 0;
    std::string mFailure;
    Worker mWorker;
};

} // namespace relume
