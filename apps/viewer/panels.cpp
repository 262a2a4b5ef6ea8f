#include "apps/viewer/panels.h"

#include "apps/viewer/controls.h"
#include "apps/viewer/panel_items.h"

#include <fmt/core.h>

namespace relume {

namespace {

constexpr float kPanelWidth = 27; // in lines of text

bool beginSection(const char* name, bool& isOpen) {
    ImGui::SetNextItemOpen(isOpen);
    return isOpen = ImGui::CollapsingHeader(name);
}

void drawMain(SceneState& state, const PanelFacts& facts, PanelRequests& requests) {
    const float highest = ImGui::GetIO().DisplaySize.y - line();
    ImGui::SetNextWindowPos({0.5f * line(), 0.5f * line()}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints({kPanelWidth * line(), 0}, {kPanelWidth * line(), highest});
    ImGui::Begin("Relume", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushItemWidth(14 * line());
    if (beginSection("Model", state.opensModel)) drawModelPanel(facts, requests);
    if (beginSection("Light", state.opensLight)) drawLightPanel(state, facts, requests);
    if (!facts.materials.empty() && beginSection("Material", state.opensMaterial))
        drawMaterialPanel(state, facts);
    if (facts.content->shown() && beginSection("Compare and inspect", state.opensTrust))
        drawTrustPanel(state, facts);
    if (beginSection("View", state.opensView)) drawViewPanel(state, facts, requests);
    if (ImGui::SmallButton("Undo")) requests.undoes = true;
    explain("Ctrl + Z: take the last change of light, material or picture back");
    ImGui::SameLine();
    if (ImGui::SmallButton("Redo")) requests.redoes = true;
    explain("Ctrl + Shift + Z");
    ImGui::SameLine();
    ImGui::TextDisabled("H: keys    Tab: hide panels");
    ImGui::PopItemWidth();
    ImGui::End();
}

void drawHelp(SceneState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin("Keys", &state.showsHelp, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
    for (const KeyHelp& help : keyHelp()) {
        text(help.keys);
        ImGui::SameLine(20 * line());
        text(help.action);
    }
    ImGui::End();
}

void drawTask(const Task& task, PanelRequests& requests) {
    text(task.title);
    if (task.fraction >= 0) {
        ImGui::SameLine();
        const std::string left =
            task.secondsLeft >= 0 ? fmt::format(", {:.0f} s left", task.secondsLeft) : "";
        ImGui::ProgressBar(float(task.fraction), {16 * line(), 0},
                           fmt::format("{:.0f} %{}", 100 * task.fraction, left).c_str());
    }
    if (!task.canCancel) return;
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) requests.cancelsBake = true;
    explain("What is baked is kept for the next time");
}

// Draws the status at the lower edge: a bake's progress, files being read, notices.
void drawStatus(const PanelFacts& facts, PanelRequests& requests) {
    const Task task = facts.content->task();
    if (task.title.empty() && facts.notice.empty()) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * size.x, size.y - 0.5f * line()}, ImGuiCond_Always, {0.5f, 1});
    ImGui::Begin("##status", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    if (!task.title.empty()) drawTask(task, requests);
    if (!facts.notice.empty()) {
        ImGui::PushTextWrapPos(0.7f * size.x);
        if (facts.isFailure)
            ImGui::TextColored({0.95f, 0.35f, 0.25f, 1}, "%s", facts.notice.c_str());
        else
            text(facts.notice);
        ImGui::PopTextWrapPos();
        ImGui::SameLine();
        if (ImGui::SmallButton("x")) requests.dismissesNotice = true;
    }
    ImGui::End();
}

} // namespace

PanelRequests drawPanels(SceneState& state, const PanelFacts& facts) {
    PanelRequests requests;
    if (state.showsPanels) {
        drawMain(state, facts, requests);
        drawTimesWindow(facts, requests);
        if (state.showsLight) drawLightVectorWindow(state, facts);
        if (facts.explanation) drawExplanationWindow(state, facts);
        drawStatus(facts, requests);
    }
    if (state.showsHelp) drawHelp(state);
    return requests;
}

} // namespace relume
