#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"

#include <bit>

namespace relume {

void drawViewPanel(SceneState& state, const PanelFacts& facts, PanelRequests& requests) {
    if (slider("Exposure", state.exposure, -8, 8, "%.2f stops")) state.exposesItself = false;
    ImGui::SameLine();
    if (ImGui::Checkbox("Auto", &state.exposesItself)) state.wantsExposure = state.exposesItself;
    explain("What the object asks for: found for every model and environment, then kept");
    constexpr const char* kCurves[] = {"None", "ACES", "AgX"};
    int curve = int(state.tone);
    if (ImGui::Combo("Tone", &curve, kCurves, 3)) state.tone = ToneCurve(curve);
    explain("How radiance becomes what a display shows");
    int samples = std::countr_zero(unsigned(state.samples));
    if (ImGui::Combo("Samples", &samples, "1\0002\0004\0008\0")) state.samples = 1 << samples;
    explain("Of a pixel, against jagged edges; fewer if the device has not as many");
    if (slider("Field of view", state.fovDegrees, 10, 100, "%.0f deg") && state.orbit)
        state.orbit->verticalFov = glm::radians(state.fovDegrees);
    ImGui::Checkbox("Turntable", &state.turns);
    explain("T");
    ImGui::SameLine();
    if (ImGui::Button("Reset")) requests.resetsView = true;
    explain("Enter: the default view");
    ImGui::SameLine();
    if (ImGui::Button("Screenshot")) requests.takesScreenshot = true;
    explain("F12: .png as it is seen, .exr of linear radiance, in the folder this was started in");
    ImGui::SameLine();
    if (ImGui::Button(facts.isRecording ? "Stop recording" : "Record")) requests.togglesRecording = true;
    explain("Ctrl + F12: write every frame without panels, thirty to a second of the scene's time; as a "
            "video, too, where "
            "ffmpeg is installed");
    ImGui::Checkbox("Dark panels", &state.isDark);
    ImGui::SameLine();
    ImGui::Checkbox("Vsync", &state.waitsForDisplay);
    explain("Show frames when the display asks for them: no tearing, no more frames than it shows");
}

} // namespace relume
