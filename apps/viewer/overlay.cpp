#include "apps/viewer/overlay.h"

#include <imgui.h>
#include <string>

namespace relume {

namespace {

constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 220), kShadow = IM_COL32(0, 0, 0, 160);

void drawWords(ImDrawList& list, ImVec2 place, const std::string& words) {
    list.AddText({place.x + 1, place.y + 1}, kShadow, words.c_str());
    list.AddText(place, kWhite, words.c_str());
}

void drawSplit(ImDrawList& list, const SceneState& state, const PanelFacts& facts, ivec2 size) {
    const float x = state.split * float(size.x), line = ImGui::GetFontSize(), y = float(size.y) - 2 * line;
    list.AddLine({x + 1, 0}, {x + 1, float(size.y)}, kShadow, 1);
    list.AddLine({x, 0}, {x, float(size.y)}, kWhite, 1);
    const std::string left = "relit";
    drawWords(list, {x - ImGui::CalcTextSize(left.c_str()).x - 0.5f * line, y}, left);
    drawWords(list, {x + 0.5f * line, y}, facts.passes > 0 ? "reference" : "reference: tracing ...");
}

void drawVertex(ImDrawList& list, const VertexExplanation& explanation, const Camera& camera, ivec2 size) {
    const auto place = pixelOf(explanation.position, camera, size);
    if (!place) return;
    list.AddCircle({place->x, place->y}, 6, kShadow, 0, 4);
    list.AddCircle({place->x, place->y}, 6, kWhite, 0, 1.5f);
}

} // namespace

void drawOverlay(const SceneState& state, const PanelFacts& facts, const Camera& camera, ivec2 size) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    if (state.compare == Compare::Split && state.inspect == Inspect::Off) drawSplit(list, state, facts, size);
    if (facts.explanation) drawVertex(list, *facts.explanation, camera, size);
}

} // namespace relume
