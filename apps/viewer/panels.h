// What is written over the view: panels, times, help, what is under way.
#pragma once

#include "apps/viewer/content.h"
#include "apps/viewer/frame_times.h"
#include "apps/viewer/pictures.h"
#include "apps/viewer/scene_state.h"
#include "apps/viewer/why.h"
#include "precompute/reference/progressive_reference.h"

namespace relume {

// Parts with the same materials.
struct PartMaterials {
    std::vector<size_t> parts;
    std::string title;                          // the parts' names
    std::vector<std::vector<std::string>> sets; // names; materials of one set can be blended
};

// What panels show beside the state they change.
struct PanelFacts {
    const Content* content = nullptr;
    const FrameTimes* times = nullptr;
    const Pictures* pictures = nullptr;
    std::vector<PartMaterials> materials;
    std::map<std::string, Picture> swatches; // by material
    std::vector<Picture> environments;       // by choice; of no size: not there yet
    Picture lightMap, lightGiven, lightKept; // of the light as it was recorded last
    std::optional<LightStats> light;
    std::string device;
    uint64_t memory = 0; // bytes of the program
    // Of the reference: passes so far, and the relit image's error.
    int passes = 0;
    std::optional<ReferenceError> error;
    const Why* why = nullptr;
    Picture visibility, transport, contributions; // of it
    bool isCapturing = false, isRecording = false;
    std::string notice; // what just happened
    bool isFailure = false;
};

// What was pressed.
struct PanelWishes {
    bool cancelsBake = false, takesScreenshot = false, togglesCapture = false, togglesRecording = false,
         resetsView = false, dismissesNotice = false, reloadsShaders = false, undoes = false, redoes = false;
    std::optional<std::filesystem::path> opens, savesLight, savesSession;
    std::optional<size_t> shows, closes; // models
};

// Between Ui::begin() and end(). Changes `state` as it is told to.
PanelWishes drawPanels(SceneState& state, const PanelFacts& facts);

// The parts of the main panel, and windows of their own.
void drawModelPanel(const PanelFacts& facts, PanelWishes& wishes);
void drawLightPanel(SceneState& state, const PanelFacts& facts, PanelWishes& wishes);
void drawMaterialPanel(SceneState& state, const PanelFacts& facts);
void drawViewPanel(SceneState& state, const PanelFacts& facts, PanelWishes& wishes);
void drawTrustPanel(SceneState& state, const PanelFacts& facts);
void drawTimesWindow(const PanelFacts& facts, PanelWishes& wishes);
void drawLightVectorWindow(SceneState& state, const PanelFacts& facts);
void drawWhyWindow(SceneState& state, const PanelFacts& facts);

} // namespace relume
