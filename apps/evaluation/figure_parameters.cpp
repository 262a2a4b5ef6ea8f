// Figure 5: what a single term gives where its map is polar.
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"

#include <fmt/format.h>

namespace relume {

namespace {

FigureSetup setupOf(const SectionInputs& inputs, const SceneInput& model, const SceneInput& light) {
    BakeOptions polar = paperOptions(1);
    polar.mapping = DiskMapping::Polar;
    BakeOptions normalized = polar;
    normalized.factorization.method = Factorization::Normalized;
    const auto recipe = [&](const std::string& material, const BakeOptions& options) {
        return sceneRecipe(inputs, "lucy", model, material, options);
    };
    FigureSetup setup{.name = "figure-5",
                      .title = "Figure 5",
                      .size = tallImage(inputs.quick),
                      .light = environmentChoice(light),
                      .images = {},
                      .effort = referenceEffort(inputs.quick),
                      .seconds = inputs.quick ? 5.0 : 80.0,
                      .truth = 3};
    setup.images = {
        {"diffuse", "grey diffuse", recipe("grey-diffuse", paperOptions(1)), {}, false},
        {"polar", "one term, polar map", recipe(kAshikhminShirley, polar), {}},
        {"normalized",
         "one term, polar map, normalized decomposition",
         recipe(kAshikhminShirley, normalized),
         {}},
        {"terms", "four terms", recipe(kAshikhminShirley, paperOptions(4)), {}},
        {"one", "one term, orthographic map", recipe(kAshikhminShirley, paperOptions(4)), {.terms = 1}}};
    setup.images.back().isShown = false;
    return setup;
}

} // namespace

Section parametersFigure(const SectionInputs& inputs) {
    Section section{"figure-5", "Figure 5: one term against four", {}, {}};
    const auto model = inputs.scenes.model("lucy");
    const auto light = inputs.scenes.environment("grace");
    if (!model || !light) return skippedSection(std::move(section), "there is no Lucy or no Grace Cathedral");
    const FigureSetup setup = setupOf(inputs, *model, *light);
    section.steps = figureSteps(setup);
    section.write = [=, light = *light, quick = inputs.quick](const StepResults& results,
                                                              ReportSection& report) {
        report.say(
            fmt::format("Lucy in grey diffuse, in a single term of Ashikhmin-Shirley from polar maps, and in "
                        "four terms from orthographic ones; under {}, the paper's light not being known. The "
                        "reference is of Ashikhmin-Shirley.",
                        describe(light)));
        report.say(quickNote(quick));
        report.add(figureOf(setup, results, describe(*model)));
        ReportTable table{"figure_5", "Relative RMSE", {"maps", "RMSE (interval)"}, {}, ""};
        for (const FigureImage& image : setup.images)
            if (image.isCompared)
                table.rows.push_back({image.title, textOf(errorOf(setup, results, image.name))});
        report.add(std::move(table));
        report.say(
            "The polar map has the azimuth along x and the sine of the angle from the normal along y.");
    };
    return section;
}

} // namespace relume
