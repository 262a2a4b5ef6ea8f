// The interactive program: a window, what is in it, and the loop that keeps it so.
#pragma once

#include "engine/math/vector.h"
#include "engine/vk/device.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace relume {

struct ViewerOptions {
    vk::DeviceOptions device;
    std::vector<std::filesystem::path> files; // bakes, meshes, scenes, sessions; environments and lights
    std::optional<ivec2> size;                // of the window; none: as the last time
    bool waitsForDisplay = true;
    std::optional<int> exitFrame;     // frames to draw before it ends by itself
    std::filesystem::path screenshot; // of the last of these; empty: none
    std::filesystem::path script, timings;
};

// Until the window is closed. Throws Error; NoDeviceError where no window can be shown.
void runViewer(const ViewerOptions& options);

} // namespace relume
