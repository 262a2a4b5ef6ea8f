// What is written over the view: panels, times, help, what is under way.
#pragma once

#include "apps/viewer/frame_times.h"
#include "apps/viewer/scene_state.h"

#include <functional>

namespace relume {

// What panels show beside the state they change.
struct PanelFacts {
    std::string file;                   // of the model; empty: none
    std::vector<std::string> materials; // that can be worn
    uint64_t vertices = 0, triangles = 0, transportBytes = 0;
    std::optional<float> bakedShare; // of a preview
    std::string device;
    std::optional<uint32_t> lightCoefficients;
    float lightError = 0;
    uint32_t allCoefficients = 0;
    const FrameTimes* times = nullptr;
    // Under way: what, how far (below 0: not to be told), seconds left (below 0 likewise).
    std::string task;
    double fraction = -1, secondsLeft = -1;
    bool canCancel = false;
    bool isCapturing = false;
    std::string notice; // what just happened
    bool isFailure = false;
};

// What was pressed.
struct PanelWishes {
    bool cancelsBake = false, takesScreenshot = false, togglesCapture = false, resetsView = false,
         dismissesNotice = false;
};

// Between Ui::begin() and end(). Changes `state` as it is told to.
PanelWishes drawPanels(SceneState& state, const PanelFacts& facts);

} // namespace relume
