// Figure 3: how many wavelet coefficients a shadow takes.
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"

#include <fmt/format.h>

namespace relume {

namespace {

constexpr int kFullGround =
    96; // quads a side: lossless transport of the paper's 148 would not fit on a device
constexpr int kCoefficients[] = {64, 96, 160, 256, kMostCoefficients};

std::string titleOf(int coefficients) {
    return coefficients == kMostCoefficients ? "lossless" : fmt::format("N = {}", coefficients);
}

FigureSetup setupOf(const SectionInputs& inputs, const SceneInput& model) {
    FigureSetup setup{.name = "figure-3",
                      .title = "Figure 3",
                      .size = wideImage(inputs.quick),
                      .azimuth = -20,
                      .elevation = 40,
                      .distance = 1.25f,
                      .light = areaChoice(60, 38, 3),
                      .images = {},
                      .effort = referenceEffort(inputs.quick),
                      .seconds = inputs.quick ? 5.0 : 60.0};
    for (const int coefficients : kCoefficients) {
        BakeRecipe recipe =
            sceneRecipe(inputs, "bunny", model, "grey-diffuse", paperOptions(1, coefficients));
        if (!inputs.quick) recipe.ground->tessellation = kFullGround;
        const std::string name = fmt::format("n{}", coefficients);
        setup.images.push_back({.name = name,
                                .title = titleOf(coefficients),
                                .recipe = recipe,
                                .relit = {.selection = {.threshold = kPaperLightThreshold}}});
        setup.images.push_back({.name = name + "-all-light",
                                .title = titleOf(coefficients),
                                .recipe = recipe,
                                .relit = {.selection = {.threshold = 0}},
                                .isShown = false});
    }
    return setup;
}

ReportTable tableOf(const FigureSetup& setup, const StepResults& results) {
    ReportTable table{
        "figure_3",
        "Relative RMSE over N",
        {"coefficients", "RMSE, light threshold 1024", "RMSE, all of the light", "bytes per vertex"},
        {},
        "All vertices, of the object and the ground, have one term. Lossless: all 24,576 coefficients, "
        "but for those that are zero in 11 bits."};
    for (size_t i = 0; i < setup.images.size(); i += 2)
        table.rows.push_back({setup.images[i].title, textOf(errorOf(setup, results, setup.images[i].name)),
                              textOf(errorOf(setup, results, setup.images[i + 1].name)),
                              fmt::format("{:.0f}", results.at(setup.name + "-" + setup.images[i].name)
                                                        .numbers.at("bytes_per_vertex")
                                                        .get<double>())});
    return table;
}

} // namespace

Section shadowFigure(const SectionInputs& inputs) {
    Section section{"figure-3", "Figure 3: the number of wavelet coefficients", {}, {}};
    const auto model = inputs.scenes.model("bunny");
    if (!model) return skippedSection(std::move(section), "there is no bunny");
    const FigureSetup setup = setupOf(inputs, *model);
    section.steps = figureSteps(setup);
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(fmt::format("The paper varies how many coefficients a transport vector keeps, and finds "
                               "96 to give visually good "
                               "shadows. The same here, for a diffuse bunny under {} on a ground of {} "
                               "vertices, the same for all N: "
                               "coarser than the paper's 22,201, since lossless transport of these would be "
                               "too large for a device. "
                               "What lossless transport leaves is the ground's vertices being far apart, and "
                               "a light of 6 x 64² texels "
                               "held against a reference of 6 x {}², and shadows of a simplified occluder.",
                               "an area light of 3 degrees' radius",
                               (setup.images[0].recipe.ground->tessellation + 1) *
                                   (setup.images[0].recipe.ground->tessellation + 1),
                               kTruthFaceSize));
        report.say(quickNote(quick));
        report.add(figureOf(setup, results, describe(*model)));
        report.add(tableOf(setup, results));
    };
    return section;
}

} // namespace relume
