#include "apps/viewer/panels.h"

#include "apps/viewer/controls.h"

#include <fmt/format.h>
#include <imgui.h>

namespace relume {

namespace {

// Sizes are in lines of text, so that all of it grows with the font.
float line() { return ImGui::GetFontSize(); }

void explain(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

void text(const std::string& words) { ImGui::TextUnformatted(words.c_str()); }

void drawLamp(LampChoice& lamp, size_t number, std::optional<size_t>& removed) {
    ImGui::PushID(int(number));
    ImGui::Separator();
    ImGui::ColorEdit3("##color", &lamp.color.x, ImGuiColorEditFlags_NoInputs);
    explain("Colour");
    ImGui::SameLine();
    text(fmt::format("Lamp {}", number + 1));
    ImGui::SameLine(ImGui::GetContentRegionAvail().x - 3 * line());
    if (ImGui::SmallButton("Remove")) removed = number;
    ImGui::SliderFloat("Azimuth", &lamp.azimuth, -180, 180, "%.0f deg");
    ImGui::SliderFloat("Elevation", &lamp.elevation, -90, 90, "%.0f deg");
    ImGui::SliderFloat("Radius", &lamp.radius, 0.5f, 60, "%.1f deg");
    explain("Angular radius: small lamps cast hard shadows");
    ImGui::SliderFloat("Brightness", &lamp.brightness, 0, 4, "%.2f");
    explain("1 lights white that faces it to radiance 1");
    ImGui::PopID();
}

void drawLight(LightState& light, const PanelFacts& facts) {
    if (light.file) {
        text(light.fileName.filename().string());
        if (light.file->moves()) {
            ImGui::Checkbox("Play", &light.plays);
            ImGui::SameLine();
            float seconds = float(light.seconds);
            if (ImGui::DragFloat("Time", &seconds, 0.05f, 0, 1e6f, "%.2f s")) light.seconds = seconds;
        }
        if (ImGui::Button("Back to environments")) light.file.reset();
        explain("Leave the light file for the environment and lamps below");
    } else {
        if (ImGui::BeginCombo("Environment", light.environments[light.environment].name.c_str())) {
            for (size_t i = 0; i < light.environments.size(); i++)
                if (ImGui::Selectable(light.environments[i].name.c_str(), i == light.environment))
                    light.environment = i;
            ImGui::EndCombo();
        }
        explain("E: the next one. Drop .exr or .hdr files to add some");
        ImGui::SliderFloat("Brightness", &light.environmentGain, 0, 4, "%.2f");
        std::optional<size_t> removed;
        for (size_t i = 0; i < light.lamps.size(); i++) drawLamp(light.lamps[i], i, removed);
        if (removed) light.lamps.erase(light.lamps.begin() + std::ptrdiff_t(*removed));
        if (ImGui::Button("Add lamp")) light.lamps.emplace_back();
        explain("A distant sphere that lights the object beside the environment");
    }
    ImGui::SliderFloat("Turn", &light.rotation, -180, 180, "%.1f deg");
    explain("Shift + right drag in the view turns the light too");
    ImGui::SliderInt("Threshold", &light.selection.threshold, 0, 32767, "%d", ImGuiSliderFlags_Logarithmic);
    explain("Light coefficients below this are dropped, where the largest is 32767: fewer are faster");
    if (facts.lightCoefficients)
        text(fmt::format("{} of {} coefficients, error {:.3f}", *facts.lightCoefficients,
                         facts.allCoefficients, facts.lightError));
}

void drawMaterial(SceneState& state, const PanelFacts& facts) {
    if (ImGui::RadioButton("as baked", state.material.empty())) state.material.clear();
    for (const std::string& name : facts.materials)
        if (ImGui::RadioButton(name.c_str(), state.material == name)) state.material = name;
    explain("M: the next one");
}

void drawView(SceneState& state, PanelWishes& wishes) {
    ImGui::SliderFloat("Exposure", &state.exposure, -8, 8, "%.1f stops");
    constexpr const char* kCurves[] = {"None", "ACES", "AgX"};
    int curve = int(state.tone);
    if (ImGui::Combo("Tone", &curve, kCurves, 3)) state.tone = ToneCurve(curve);
    if (ImGui::SliderFloat("Field of view", &state.fovDegrees, 10, 100, "%.0f deg") && state.orbit)
        state.orbit->verticalFov = glm::radians(state.fovDegrees);
    ImGui::Checkbox("Turntable", &state.turns);
    ImGui::SameLine();
    if (ImGui::Button("Reset")) wishes.resetsView = true;
    explain("Enter: the default view");
    ImGui::SameLine();
    if (ImGui::Button("Screenshot")) wishes.takesScreenshot = true;
    explain("F12: .png as it is seen, .exr of linear radiance, in the folder this was started in");
    ImGui::Checkbox("Dark panels", &state.isDark);
}

void drawModel(const PanelFacts& facts) {
    text(facts.file);
    text(fmt::format("{} vertices, {} triangles", facts.vertices, facts.triangles));
    text(fmt::format("transport: {:.1f} MB, {:.0f} bytes a vertex", double(facts.transportBytes) * 1e-6,
                     double(facts.transportBytes) / double(std::max<uint64_t>(1, facts.vertices))));
    if (facts.bakedShare) text(fmt::format("a preview: {:.0f} % is baked", 100 * *facts.bakedShare));
}

void drawControls(SceneState& state, const PanelFacts& facts, PanelWishes& wishes) {
    ImGui::SetNextWindowPos({0.5f * line(), 0.5f * line()}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints({24 * line(), 0},
                                        {24 * line(), ImGui::GetIO().DisplaySize.y - line()});
    ImGui::Begin("Relume", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushItemWidth(12 * line());
    if (!facts.file.empty() && ImGui::CollapsingHeader("Model")) drawModel(facts);
    if (ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen)) drawLight(state.light, facts);
    if (!facts.materials.empty() && ImGui::CollapsingHeader("Material", ImGuiTreeNodeFlags_DefaultOpen))
        drawMaterial(state, facts);
    if (ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) drawView(state, wishes);
    ImGui::TextDisabled("H: keys    Tab: hide panels");
    ImGui::PopItemWidth();
    ImGui::End();
}

void drawTimes(const PanelFacts& facts, PanelWishes& wishes) {
    const FrameTimes& times = *facts.times;
    ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - 0.5f * line(), 0.5f * line()}, ImGuiCond_Always,
                            {1, 0});
    ImGui::Begin("Times", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoMove);
    text(fmt::format("{:.1f} frames/s", times.framesPerSecond()));
    explain("When frames follow each other. Where nothing changes, none is drawn");
    const std::vector<float> milliseconds = times.milliseconds();
    float highest = 20;
    for (const float time : milliseconds) highest = std::max(highest, time);
    ImGui::PlotLines("##frames", milliseconds.data(), int(milliseconds.size()), 0,
                     fmt::format("up to {:.0f} ms", highest).c_str(), 0, highest, {15 * line(), 3 * line()});
    for (const auto& [name, seconds] : times.passes()) {
        text(name);
        ImGui::SameLine(10 * line());
        text(fmt::format("{:7.2f} ms", 1e3 * seconds));
    }
    ImGui::TextDisabled("%s", facts.device.c_str());
    if (ImGui::SmallButton(facts.isCapturing ? "Stop capture" : "Capture")) wishes.togglesCapture = true;
    explain("F9: write what every frame spends its time on, for trace viewers");
    ImGui::End();
}

void drawHelp(SceneState& state) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::Begin("Keys", &state.showsHelp, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
    for (const KeyHelp& help : keyHelp()) {
        text(help.keys);
        ImGui::SameLine(20 * line());
        text(help.action);
    }
    ImGui::End();
}

// At the lower edge: a bake's progress, what is read, what happened.
void drawStatus(const PanelFacts& facts, PanelWishes& wishes) {
    if (facts.task.empty() && facts.notice.empty()) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * size.x, size.y - 0.5f * line()}, ImGuiCond_Always, {0.5f, 1});
    ImGui::Begin("##status", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    if (!facts.task.empty()) {
        text(facts.task);
        if (facts.fraction >= 0) {
            ImGui::SameLine();
            const std::string left =
                facts.secondsLeft >= 0 ? fmt::format(", {:.0f} s left", facts.secondsLeft) : "";
            ImGui::ProgressBar(float(facts.fraction), {16 * line(), 0},
                               fmt::format("{:.0f} %{}", 100 * facts.fraction, left).c_str());
        }
        if (facts.canCancel) {
            ImGui::SameLine();
            if (ImGui::Button("Cancel")) wishes.cancelsBake = true;
            explain("What is baked is kept for the next time");
        }
    }
    if (!facts.notice.empty()) {
        ImGui::PushTextWrapPos(0.7f * size.x);
        if (facts.isFailure)
            ImGui::TextColored({0.95f, 0.35f, 0.25f, 1}, "%s", facts.notice.c_str());
        else
            text(facts.notice);
        ImGui::PopTextWrapPos();
        ImGui::SameLine();
        if (ImGui::SmallButton("x")) wishes.dismissesNotice = true;
    }
    ImGui::End();
}

} // namespace

PanelWishes drawPanels(SceneState& state, const PanelFacts& facts) {
    PanelWishes wishes;
    if (state.showsPanels) {
        drawControls(state, facts, wishes);
        drawTimes(facts, wishes);
        drawStatus(facts, wishes);
    }
    if (state.showsHelp) drawHelp(state);
    return wishes;
}

} // namespace relume
