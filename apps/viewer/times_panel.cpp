#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

void drawTimesWindow(const PanelFacts& facts, PanelRequests& requests) {
    const FrameTimes& times = *facts.times;
    ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - 0.5f * line(), 0.5f * line()}, ImGuiCond_Always,
                            {1, 0});
    ImGui::SetNextWindowCollapsed(true, ImGuiCond_FirstUseEver);
    requests.showsTimes = ImGui::Begin(
        fmt::format("Profiler: {:.0f} frames/s###profiler", times.framesPerSecond()).c_str(), nullptr,
        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoMove);
    if (!requests.showsTimes) return ImGui::End();
    text("Time of each frame");
    explain("From input to image. Where nothing changes, no frame is drawn");
    const std::vector<float> milliseconds = times.milliseconds();
    float highest = 20;
    for (const float time : milliseconds) highest = std::max(highest, time);
    ImGui::PlotLines("##frames", milliseconds.data(), int(milliseconds.size()), 0,
                     fmt::format("up to {:.0f} ms", highest).c_str(), 0, highest, {17 * line(), 3 * line()});
    for (const FrameTimes::Pass& pass : times.passes()) {
        const bool isOld = !times.isOfLastFrame(pass);
        if (isOld) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        text(pass.name);
        ImGui::SameLine(11 * line());
        text(fmt::format("{:7.2f} ms", 1e3 * pass.seconds));
        if (isOld) ImGui::PopStyleColor();
    }
    explain("Device time of each pass; gray: of the last frame that needed it");
    if (facts.light) {
        text(fmt::format("{} coefficients of light", facts.light->kept));
        explain("That were kept for relighting; the rest counts as zero");
    }
    text(fmt::format("{:.0f} MB of memory", double(facts.memory) * 1e-6));
    ImGui::PushTextWrapPos(17 * line());
    ImGui::TextDisabled("%s", facts.device.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::SmallButton(facts.isCapturing ? "Stop capture" : "Capture")) requests.togglesCapture = true;
    explain("F9: write what every frame spends its time on, for trace viewers");
    ImGui::SameLine();
    if (ImGui::SmallButton("Rebuild shaders")) requests.reloadsShaders = true;
    explain("F5: build the shaders anew from their sources");
    ImGui::End();
}

} // namespace relume
