#include "apps/viewer/cube_images.h"
#include "apps/viewer/outputs.h"
#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"
#include "engine/light/light_vector.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr float kPanelMapWidth = 25; // in lines of text
constexpr int kThumbnailsPerRow = 4;

void drawLamp(LampChoice& lamp, size_t number, float leastDegrees, std::optional<size_t>& removed) {
    ImGui::PushID(int(number));
    ImGui::ColorEdit3("##color", &lamp.color.x, ImGuiColorEditFlags_NoInputs);
    explain("Color");
    ImGui::SameLine();
    text(fmt::format("Lamp {}", number + 1));
    ImGui::SameLine(ImGui::GetContentRegionAvail().x - 4 * line());
    if (ImGui::SmallButton("Remove")) removed = number;
    slider("Azimuth", lamp.azimuth, -180, 180, "%.0f deg");
    explain("Or drag its handle on the sphere around the object");
    slider("Elevation", lamp.elevation, -90, 90, "%.0f deg");
    slider("Radius", lamp.radius, 0.5f, 60, "%.1f deg");
    explain("Angular radius: small lamps cast hard shadows");
    if (lamp.radius < leastDegrees)
        ImGui::TextDisabled("below %.0f deg this bake's shadows are patchy", double(leastDegrees));
    slider("Brightness", lamp.brightness, 0, 4, "%.2f");
    explain("1 lights white that faces it to radiance 1");
    ImGui::Separator();
    ImGui::PopID();
}

void drawLamps(std::vector<LampChoice>& lamps, float leastDegrees) {
    std::optional<size_t> removed;
    for (size_t i = 0; i < lamps.size(); i++) drawLamp(lamps[i], i, leastDegrees, removed);
    if (removed) lamps.erase(lamps.begin() + std::ptrdiff_t(*removed));
}

void drawAddLamp(std::vector<LampChoice>& lamps) {
    if (ImGui::Button("Add lamp") && lamps.size() < kMostSources) {
        lamps.emplace_back();
        lamps.back().azimuth = std::remainder(40 + 75 * float(lamps.size() - 1), 360.0f);
    }
    explain("A distant sphere that lights the object too; drag it in the view");
}

void drawEnvironments(LightState& light, const PanelFacts& facts) {
    const float width =
        (kPanelMapWidth * line() - 3 * ImGui::GetStyle().ItemSpacing.x) / kThumbnailsPerRow - 5;
    int shown = 0;
    for (size_t i = 0; i < light.environments.size(); i++) {
        const Picture picture = i < facts.environments.size() ? facts.environments[i] : Picture{};
        if (!picture) continue;
        if (shown++ % kThumbnailsPerRow) ImGui::SameLine();
        if (facts.pictures->drawButton(fmt::format("environment {}", i).c_str(), picture, width,
                                       i == light.environment))
            light.environment = i;
        explain(light.environments[i].name.c_str());
    }
    if (ImGui::BeginCombo("Environment", light.chosen().name.c_str())) {
        for (size_t i = 0; i < light.environments.size(); i++) {
            ImGui::PushID(int(i)); // names may repeat
            if (ImGui::Selectable(light.environments[i].name.c_str(), i == light.environment))
                light.environment = i;
            explain(light.environments[i].file.string().c_str());
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    explain("E: the next one. Drop .exr or .hdr files to add some");
    slider("Brightness", light.environmentGain, 0, 4, "%.2f");
}

void drawSky(DaySkyChoice& sky) {
    slider("Hour", sky.hour, 0, 24, "%.2f h");
    explain("Solar time: the sun is highest at 12. Space lets the day pass");
    slider("Day", sky.dayOfYear, 1, 365, "day %d");
    slider("Latitude", sky.latitude, -90, 90, "%.0f deg");
    slider("Turbidity", sky.turbidity, 2, 10, "%.1f");
    explain("Haze: 2 is clear, 10 hazy");
}

// Draws the light as recorded. Dragging on it paints strokes.
void drawMap(LightState& light, const Brush& b, const PanelFacts& facts) {
    if (!facts.lightMap) return;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{kPanelMapWidth * line(), 0.5f * kPanelMapWidth * line()};
    facts.pictures->draw(facts.lightMap, size.x);
    if (light.file) return;
    const bool isHovered = ImGui::IsItemHovered();
    if (!b.isInHand) return explain("What lights the object, as a map of all directions");
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const MapAngles angles = anglesAt({(mouse.x - corner.x) / size.x, (mouse.y - corner.y) / size.y});
    if (!isHovered) return;
    const float across = b.radius / 180 * size.y;
    ImGui::GetWindowDrawList()->AddCircle(mouse, across, IM_COL32(255, 255, 255, 200));
    const ImVec2 pressed = ImGui::GetIO().MouseClickedPos[ImGuiMouseButton_Left];
    const bool isPressedHere = pressed.x >= corner.x && pressed.y >= corner.y &&
                               pressed.x < corner.x + size.x && pressed.y < corner.y + size.y;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) || !isPressedHere) return;
    const StrokeChoice stroke{std::remainder(angles.azimuth - light.rotation, 360.0f), angles.elevation,
                              b.radius, b.brightness * b.color, b.opacity};
    const bool begins = light.strokes.empty() || ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    for (const StrokeChoice& next :
         begins ? std::vector<StrokeChoice>{stroke} : strokesTo(light.strokes.back(), stroke))
        if (light.strokes.size() < kMostSources) light.strokes.push_back(next);
}

void drawBrush(LightState& light, Brush& b) {
    ImGui::Checkbox("Paint", &b.isInHand);
    explain("Drag over the map above");
    if (!light.strokes.empty()) {
        ImGui::SameLine();
        if (ImGui::Button("Clear")) light.strokes.clear();
        ImGui::SameLine();
        ImGui::TextDisabled("%zu of %zu touches", light.strokes.size(), kMostSources);
    }
    if (!b.isInHand) return;
    ImGui::ColorEdit3("Color", &b.color.x, ImGuiColorEditFlags_NoInputs);
    slider("Brush", b.radius, 2, 90, "%.0f deg");
    slider("Radiance", b.brightness, 0, 50, "%.2f", ImGuiSliderFlags_Logarithmic);
    slider("Opacity", b.opacity, 0, 1, "%.2f");
}

void drawFile(LightState& light) {
    text(light.fileName.filename().string());
    if (light.file->moves()) {
        float seconds = float(light.seconds);
        if (ImGui::DragFloat("Time", &seconds, 0.05f, 0, 1e6f, "%.2f s", ImGuiSliderFlags_AlwaysClamp) &&
            std::isfinite(seconds))
            light.seconds = seconds;
    }
    if (ImGui::Button("Back to environments")) light.file.reset();
    explain("Leave the light file for environments, sky and lamps");
}

void drawSelection(LightSelection& selection) {
    if (selection.threshold) {
        slider("Threshold", *selection.threshold, 0, kLightMaximum, "%d", ImGuiSliderFlags_Logarithmic);
        return explain("Light coefficients below this are dropped, where the largest is 32767");
    }
    slider("Coefficients", selection.count, 1, int(kMaximumLightEntries), "%d", ImGuiSliderFlags_Logarithmic);
    explain("The so many largest of the light are kept: fewer are faster, and further from the light");
}

void drawBackground(SceneState& state) {
    constexpr const char* kBackgrounds[] = {"Environment", "None"};
    int behind = int(state.background);
    if (ImGui::Combo("Background", &behind, kBackgrounds, 2)) state.background = BackgroundKind(behind);
    explain("What is seen behind the object; lamps light it and are not seen");
    if (state.background == BackgroundKind::None) return;
    slider("Blur", state.backgroundBlur, 0, 30, "%.1f deg");
    explain("The background out of focus; the light stays as it is");
    constexpr const char* kGrounds[] = {"Whole", "Faded", "Shadow"};
    int ground = int(state.ground);
    if (ImGui::Combo("Ground", &ground, kGrounds, 3)) state.ground = GroundStyle(ground);
    explain("As it is, fading around the object, or as a shadow on the background; a map of differences "
            "shows all of it");
}

} // namespace

void drawLightPanel(SceneState& state, const PanelFacts& facts, PanelRequests& requests) {
    LightState& light = state.light;
    if (light.file)
        drawFile(light);
    else {
        drawEnvironments(light, facts);
        if (light.isDay()) drawSky(light.sky);
    }
    drawMap(light, state.brush, facts);
    if (!light.file) {
        drawBrush(light, state.brush);
        drawAddLamp(light.lamps);
        ImGui::SameLine();
        requests.savesLight = saveButton(
            "Save light", "Write it as a light file, for `relume render --light`", outputName(".light.json"));
        ImGui::SameLine();
    }
    ImGui::Checkbox("Play", &light.plays);
    explain("Space: a light file's time passes, the day does, else all of the light turns");
    if (!light.file) {
        const auto& model = facts.content->shown();
        drawLamps(light.lamps,
                  model && !model->isSketch ? glm::degrees(smallestLampRadius(model->asset)) : 0);
    }
    slider("Rotation", light.rotation, -180, 180, "%.1f deg");
    explain("Shift + right drag in the view turns the light too");
    drawSelection(light.selection);
    drawBackground(state);
}

} // namespace relume
