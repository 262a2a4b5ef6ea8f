#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr float kCrossWidth = 12; // in lines of text

void drawDot(vec3 value) { text(fmt::format("{:9.4f} {:9.4f} {:9.4f}", value.x, value.y, value.z)); }

// Begins a window at the lower edge, `fromRight` lines of text from the right edge.
bool beginAtRight(const char* name, bool& isOpen, float fromRight = 0.5f) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - fromRight * line(), size.y - 0.5f * line()}, ImGuiCond_FirstUseEver,
                            {1, 1});
    ImGui::SetNextWindowBgAlpha(1); // other panels may be behind it
    return ImGui::Begin(name, &isOpen,
                        ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
}

} // namespace

void drawTrustPanel(SceneState& state, const PanelFacts& facts) {
    text("Compare with ray tracing");
    explain("C: the same view by Embree, with the exact BRDF and exact shadows, found in the background");
    chooseOne({"off", "split", "reference", "difference"}, state.compare);
    if (state.compare != Compare::Off) {
        if (facts.passes == 0)
            ImGui::TextDisabled("tracing the first pass ...");
        else if (!facts.error)
            ImGui::TextDisabled("1 pass");
        else
            text(fmt::format("RMS error {:.4f}, {:.1f} %; after {} passes,\nwhose own noise is {:.4f}",
                             facts.error->rmse, 100 * facts.error->rmse / std::max(1e-9, facts.error->level),
                             facts.passes, facts.error->noise));
        explain("Root mean square of the relit image's error over covered pixels, without the reference's "
                "own noise");
        if (state.compare == Compare::Difference)
            ImGui::TextDisabled("black: none; yellow: a quarter of white");
    }
    text("Inspect");
    explain("I: what the mesh is like");
    chooseOne({"off", "wireframe", "normals", "density"}, state.inspect);
    if (state.inspect == Inspect::Density) ImGui::TextDisabled("triangles: red small, blue large (16 times)");
    ImGui::Checkbox("Light vector", &state.showsLight);
    explain("L: the light as it was given, and what its kept coefficients stand for");
    ImGui::SameLine();
    ImGui::TextDisabled("W: why this color?");
    explain("Point at the object and press W: what the vertex there sees, and which light reaches the eye");
}

void drawLightVectorWindow(SceneState& state, const PanelFacts& facts) {
    if (beginAtRight("Light vector", state.showsLight, 2 * kCrossWidth + 3) && facts.lightGiven &&
        facts.light) {
        const int side = facts.content->shown() ? facts.content->shown()->asset.faceSize : 0;
        ImGui::BeginGroup();
        text(fmt::format("given: 6 x {0} x {0}", side));
        facts.pictures->draw(facts.lightGiven, kCrossWidth * line());
        ImGui::EndGroup();
        ImGui::SameLine();
        ImGui::BeginGroup();
        text(fmt::format("kept: {} coefficients", facts.light->kept));
        facts.pictures->draw(facts.lightKept, kCrossWidth * line());
        ImGui::EndGroup();
        text(fmt::format("error {:.4f}, relative, root mean square", facts.light->error));
        explain("Of all coefficients, by what was dropped and rounded");
    }
    ImGui::End();
}

void drawExplanationWindow(SceneState& state, const PanelFacts& facts) {
    const VertexExplanation& explanation = *facts.explanation;
    if (beginAtRight("Why this color?", state.showsExplanation)) {
        text(fmt::format("{}, vertex {} at {:.3f} {:.3f} {:.3f}", explanation.part, explanation.vertex,
                         explanation.position.x, explanation.position.y, explanation.position.z));
        ImGui::BeginGroup();
        text(fmt::format("sees: {:.0f} % open", 100 * explanation.openShare));
        facts.pictures->draw(facts.visibility, kCrossWidth * line());
        explain("The visibility cube: white is open, dark is blocked; only what is above its horizon");
        ImGui::EndGroup();
        ImGui::SameLine();
        ImGui::BeginGroup();
        text("what light counts for");
        facts.pictures->draw(facts.transport, kCrossWidth * line());
        explain("The transport vector from this eye: what each texel of light adds, visibility, BRDF and "
                "cosine in one");
        ImGui::EndGroup();
        text("the light that reaches the eye from it");
        facts.pictures->draw(facts.contributions, (2 * kCrossWidth + 0.6f) * line());
        explain("The environment in gray; colored: light times what it counts for, yellow most");
        text(fmt::format("radiance {:.4f} {:.4f} {:.4f}; its {} terms:", explanation.radiance.x,
                         explanation.radiance.y, explanation.radiance.z, explanation.tuple.size()));
        if (ImGui::BeginChild("terms", {0, std::min<float>(4, float(explanation.tuple.size())) *
                                                   ImGui::GetTextLineHeightWithSpacing() +
                                               line()}))
            for (const vec3& term : explanation.tuple) drawDot(term);
        ImGui::EndChild();
    }
    ImGui::End();
}

} // namespace relume
