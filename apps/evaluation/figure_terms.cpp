// Figure 2: how many terms a BRDF takes, seen on its highlights.
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"

namespace relume {

namespace {

constexpr int kFace = 64; // of the lighting cube, in which a distant light is four texels

FigureSetup setupOf(const SectionInputs& inputs, const SceneInput& model) {
    const int most = inputs.quick ? 16 : 32;
    BakeRecipe recipe = sceneRecipe(inputs, "buddha", model, kAshikhminShirley, paperOptions(most));
    recipe.ground.reset(); // its error would hide that of the highlights
    FigureSetup setup{.name = "figure-2",
                      .title = "Figure 2",
                      .size = tallImage(inputs.quick),
                      .light = distantChoice(20, 45, kFace),
                      .images = {},
                      .effort = referenceEffort(inputs.quick),
                      .seconds = inputs.quick ? 15.0 : 400.0};
    for (int terms = 1; terms <= most; terms *= 2)
        setup.images.push_back(
            {fmt::format("k{}", terms), fmt::format("K = {}", terms), recipe, {.terms = terms}});
    return setup;
}

} // namespace

Section termsFigure(const SectionInputs& inputs) {
    Section section{"figure-2", "Figure 2: the number of BRDF terms", {}, {}};
    const auto model = inputs.scenes.model("buddha");
    if (!model) return skippedSection(std::move(section), "there is no Buddha");
    const FigureSetup setup = setupOf(inputs, *model);
    section.steps = figureSteps(setup);
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(
            "The paper shows the Buddha in Ashikhmin and Shirley's BRDF (kd 0.5, ks 0.75, nu 10, nv 100) "
            "under a single distant light, and finds four terms visually accurate. Here all images are the "
            "first K terms of one bake, in the paper's factorisation, maps of 48 x 48, rows of 96 "
            "coefficients; the reference has the analytic BRDF under the same light, in the texels of "
            "6 x 64². There is no ground, so that the error is that of the highlights. What K cannot mend is "
            "lost to the coefficients: a single direction needs all of them.");
        report.say(quickNote(quick));
        report.add(figureOf(setup, results, describe(*model)));
        ReportTable table{"figure_2", "Relative RMSE over K", {"terms K", "RMSE (interval)"}, {}, ""};
        for (const FigureImage& image : setup.images)
            table.rows.push_back({image.title, textOf(errorOf(setup, results, image.name))});
        report.add(std::move(table));
    };
    return section;
}

} // namespace relume
