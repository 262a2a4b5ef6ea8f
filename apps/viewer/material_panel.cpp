#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr float kSwatchWidth = 4; // lines
constexpr int kSwatchesPerRow = 5;

bool showsOnly(const SceneState& state, const std::string& name) {
    return state.material.size() == 1 && state.material[0].name == name;
}

void drawSwatches(SceneState& state, const PanelFacts& facts) {
    if (ImGui::RadioButton("as baked", state.material.empty())) state.material.clear();
    explain("M: the next one");
    int shown = 0;
    for (const std::string& name : facts.materials) {
        const auto swatch = facts.swatches.find(name);
        if (swatch != facts.swatches.end() && swatch->second) {
            if (shown++ % kSwatchesPerRow) ImGui::SameLine();
            if (facts.pictures->drawButton(name.c_str(), swatch->second, kSwatchWidth * line(),
                                           showsOnly(state, name)))
                state.material = {{name}};
            explain(name.c_str());
        } else if (ImGui::RadioButton(name.c_str(), showsOnly(state, name)))
            state.material = {{name}};
    }
}

// Sliders of the set that holds what is bound, else of the first that has several materials.
void drawBlend(SceneState& state, const std::vector<std::vector<std::string>>& sets) {
    const auto holds = [&](const std::vector<std::string>& set) {
        return std::ranges::any_of(state.material, [&](const WeightedMaterial& bound) {
            return std::ranges::find(set, bound.name) != set.end();
        });
    };
    auto set = std::ranges::find_if(sets, holds);
    if (set == sets.end()) set = sets.begin();
    std::vector<WeightedMaterial> blend;
    bool hasChanged = false;
    float sum = 0;
    for (const std::string& name : *set) {
        const auto bound = std::ranges::find(state.material, name, &WeightedMaterial::name);
        WeightedMaterial material{name, bound == state.material.end() ? 0 : bound->weight};
        hasChanged |= slider(name.c_str(), material.weight, 0, 1, "%.2f");
        sum += material.weight;
        if (material.weight > 0) blend.push_back(material);
    }
    if (hasChanged && sum > 0) state.material = blend;
}

} // namespace

void drawMaterialPanel(SceneState& state, const PanelFacts& facts) {
    drawSwatches(state, facts);
    if (!facts.materialSets.empty() && ImGui::TreeNode("Blend")) {
        explain("Weights of a set's materials, over their sum");
        drawBlend(state, facts.materialSets);
        ImGui::TreePop();
    }
    const int most = termsOf(*facts.content->shown());
    int terms = state.terms > 0 ? std::min(state.terms, most) : most;
    if (slider("Terms", terms, 1, most, fmt::format("%d of {}", most).c_str()))
        state.terms = terms < most ? terms : 0;
    explain("- and =: how many of the BRDF's K products are summed; fewer are further from the material");
    ImGui::Checkbox("Residual", &state.addsResidual);
    explain("Add what the terms leave of the BRDF, in proportion to the light that reaches a point");
}

} // namespace relume
