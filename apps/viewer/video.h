// Videos of recordings, by the program ffmpeg.
#pragma once

#include <filesystem>
#include <optional>

namespace relume {

// Looks for ffmpeg in $PATH.
std::optional<std::filesystem::path> findFfmpeg();

// Makes `video` (H.264, 4:2:0, as players expect it) of frame_0001.png … in `folder`; an odd row or column is
// cut off. Waits until it is there. Throws Error with what ffmpeg says.
void encodeVideo(const std::filesystem::path& ffmpeg, const std::filesystem::path& folder,
                 double framesPerSecond, const std::filesystem::path& video);

} // namespace relume
