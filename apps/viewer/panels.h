// Everything drawn over the view: panels, times, help, background work.
#pragma once

#include "apps/viewer/content.h"
#include "apps/viewer/frame_times.h"
#include "apps/viewer/pictures.h"
#include "apps/viewer/scene_state.h"
#include "apps/viewer/vertex_explanation.h"
#include "precompute/reference/progressive_reference.h"

namespace relume {

// Parts with the same materials.
struct PartMaterials {
    std::vector<size_t> parts;
    std::string title;                          // names of the parts
    std::vector<std::vector<std::string>> sets; // names; materials of one set can be blended
};

// Values that panels show besides the state that they change.
struct PanelFacts {
    const Content* content = nullptr;
    const FrameTimes* times = nullptr;
    const Pictures* pictures = nullptr;
    std::vector<PartMaterials> materials;
    std::map<std::string, Picture> swatches; // by material
    std::vector<Picture> environments;       // by choice; empty: not there yet
    Picture lightMap, lightGiven, lightKept; // of the light recorded last
    std::optional<LightStats> light;
    std::string device;
    uint64_t memory = 0;                 // that the program uses, in bytes
    int passes = 0;                      // of the reference
    std::optional<ReferenceError> error; // of the relit image
    const VertexExplanation* explanation = nullptr;
    Picture visibility, transport, contributions; // pictures of `explanation`
    bool isCapturing = false, isRecording = false;
    std::string notice; // the latest message
    bool isFailure = false;
};

// Requests that the user made in the panels.
struct PanelRequests {
    bool cancelsBake = false, takesScreenshot = false, togglesCapture = false, togglesRecording = false,
         resetsView = false, dismissesNotice = false, reloadsShaders = false, undoes = false, redoes = false,
         showsTimes = false; // the profiler is unfolded
    std::optional<std::filesystem::path> opens, savesLight, savesSession;
    std::optional<size_t> shows, closes; // indices of models
};

// Draws all panels, between Ui::begin() and end(), and changes `state` as the user does.
PanelRequests drawPanels(SceneState& state, const PanelFacts& facts);

// The sections of the main panel, and separate windows.
void drawModelPanel(const PanelFacts& facts, PanelRequests& requests);
void drawLightPanel(SceneState& state, const PanelFacts& facts, PanelRequests& requests);
void drawMaterialPanel(SceneState& state, const PanelFacts& facts);
void drawViewPanel(SceneState& state, const PanelFacts& facts, PanelRequests& requests);
void drawTrustPanel(SceneState& state, const PanelFacts& facts);
void drawTimesWindow(const PanelFacts& facts, PanelRequests& requests);
void drawLightVectorWindow(SceneState& state, const PanelFacts& facts);
void drawExplanationWindow(SceneState& state, const PanelFacts& facts);

} // namespace relume
