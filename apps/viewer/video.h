// Videos of recordings, made by the program ffmpeg.
#pragma once

#include <filesystem>
#include <optional>

namespace relume {

// Makes FOLDER.mp4 (H.264, 4:2:0, without the last row or column of an odd size) from frame_0001.png … in the
// folder, whole or not at all. Waits for ffmpeg. Returns the video's name, or nothing where ffmpeg is not
// installed. Throws Error with the messages of ffmpeg.
std::optional<std::filesystem::path> encodeVideo(const std::filesystem::path& folder, double framesPerSecond);

} // namespace relume
