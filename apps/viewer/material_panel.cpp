#include "apps/viewer/panel_items.h"
#include "apps/viewer/panels.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr float kSwatchWidth = 4; // in lines of text
constexpr int kSwatchesPerRow = 5;

std::vector<std::string> namesOf(const PartMaterials& group) {
    std::vector<std::string> names;
    for (const std::vector<std::string>& set : group.sets)
        for (const std::string& name : set)
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names;
}

float weightOf(const SceneState& state, const std::string& name) {
    const auto bound = std::ranges::find(state.material, name, &WeightedMaterial::name);
    return bound == state.material.end() ? 0 : bound->weight;
}

void drawSwatches(SceneState& state, const PartMaterials& group, const PanelFacts& facts) {
    const std::vector<std::string> names = namesOf(group);
    int shown = 0;
    for (const std::string& name : names) {
        const auto choose = [&] { bindBlend(state, names, {{name}}); };
        const bool isBound = weightOf(state, name) > 0;
        const auto swatch = facts.swatches.find(name);
        if (swatch != facts.swatches.end() && swatch->second) {
            if (shown++ % kSwatchesPerRow) ImGui::SameLine();
            if (facts.pictures->drawButton(name.c_str(), swatch->second, kSwatchWidth * line(), isBound))
                choose();
            explain(name.c_str());
        } else if (ImGui::RadioButton(name.c_str(), isBound))
            choose();
    }
}

// Draws blend sliders of the set that holds the bound material, else of the first set with several materials.
void drawBlend(SceneState& state, const PartMaterials& group) {
    const auto isBound = [&](const std::vector<std::string>& set) {
        return set.size() > 1 &&
               std::ranges::any_of(set, [&](const std::string& name) { return weightOf(state, name) > 0; });
    };
    const auto hasSeveral = [](const std::vector<std::string>& set) { return set.size() > 1; };
    auto set = std::ranges::find_if(group.sets, isBound);
    if (set == group.sets.end()) set = std::ranges::find_if(group.sets, hasSeveral);
    if (set == group.sets.end() || !ImGui::TreeNode("Blend")) return;
    explain("Weights of a set's materials, over their sum");
    std::vector<WeightedMaterial> blend;
    bool hasChanged = false;
    for (const std::string& name : *set) {
        WeightedMaterial material{name, weightOf(state, name)};
        hasChanged |= slider(name.c_str(), material.weight, 0, 1, "%.2f");
        if (material.weight > 0) blend.push_back(material);
    }
    if (hasChanged && !blend.empty()) bindBlend(state, namesOf(group), blend);
    ImGui::TreePop();
}

bool isPicked(const SceneState& state, const PartMaterials& group) {
    return state.picked && std::ranges::find(group.parts, *state.picked) != group.parts.end();
}

void drawGroup(SceneState& state, const PartMaterials& group, const PanelFacts& facts) {
    ImGui::PushID(group.title.c_str());
    if (facts.materials.size() > 1) {
        if (isPicked(state, group))
            text(group.title);
        else
            ImGui::TextDisabled("%s", group.title.c_str());
        explain("The parts that these materials are for; click on the object to pick one");
    }
    drawSwatches(state, group, facts);
    drawBlend(state, group);
    ImGui::PopID();
}

} // namespace

void drawMaterialPanel(SceneState& state, const PanelFacts& facts) {
    if (ImGui::RadioButton("as baked", state.material.empty())) state.material.clear();
    explain("M: the next material of the bake");
    // List the picked part's materials first.
    for (const bool first : {true, false})
        for (const PartMaterials& group : facts.materials)
            if (isPicked(state, group) == first) drawGroup(state, group, facts);
    const int most = termsOf(*facts.content->shown());
    int terms = state.terms > 0 ? std::min(state.terms, most) : most;
    if (slider("Terms", terms, 1, most, fmt::format("%d of {}", most).c_str()))
        state.terms = terms < most ? terms : 0;
    explain("- and =: how many of the BRDF's K products are summed; fewer are further from the material");
    ImGui::Checkbox("Residual", &state.addsResidual);
    explain("Add what the terms leave of the BRDF, in proportion to the light that reaches a point");
}

} // namespace relume
