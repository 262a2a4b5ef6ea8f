#include "apps/evaluation/paper_models.h"

#include <fmt/format.h>

namespace relume {

namespace {

// Tables 1 and 2.
constexpr std::array kModels = {
    PaperModel{"bunny", 36e3, 22e3, {21, 70}, {30, 84}, {90, 63}, {20, 7.2}},
    PaperModel{"buddha", 56e3, 31e3, {35, 101}, {44, 127}, {46, 35}, {14, 5.0}},
    PaperModel{"dragon", 100e3, 63e3, {70, 194}, {81, 230}, {24, 18}, {7.8, 2.7}},
    PaperModel{"lucy", 180e3, 23e3, {80, 233}, {100, 370}, {18, 12}, {6.2, 1.7}},
};

} // namespace

std::vector<PaperScene> paperScenes(const SectionInputs& inputs) {
    std::vector<PaperScene> scenes;
    for (const PaperModel& model : kModels)
        if (const auto input = inputs.scenes.model(model.name); input && input->standsFor.empty())
            scenes.push_back({&model, *input});
    return scenes;
}

BakeRecipe paperRecipe(const SectionInputs& inputs, const PaperScene& scene, int terms) {
    BakeRecipe recipe =
        sceneRecipe(inputs, scene.model->name, scene.input, kAshikhminShirley, paperOptions(terms));
    recipe.name += fmt::format(", K = {}", terms);
    return recipe;
}

} // namespace relume
