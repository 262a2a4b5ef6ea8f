// Figure 2: how many terms a BRDF takes, seen on its highlights.
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"

#include <fmt/format.h>

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

// As rays see the terms of a factorisation.
FigureSetup tracedOf(FigureSetup setup, const char* name, const BakeOptions& options) {
    setup.name += name;
    setup.seconds /= 6;
    for (FigureImage& image : setup.images) image.recipe.options = options;
    return setup;
}

// Options for the same number of terms, nested: the first k of them are the factorization into k.
BakeOptions environmentOptions(const FigureSetup& setup) {
    BakeOptions options;
    options.factorization = {.terms = setup.images.back().relit.terms, .method = Factorization::Environment};
    return options;
}

} // namespace

Section termsFigure(const SectionInputs& inputs) {
    Section section{"figure-2", "Figure 2: the number of BRDF terms", {}, {}};
    const auto model = inputs.scenes.model("buddha");
    if (!model) return skippedSection(std::move(section), "there is no Buddha");
    const FigureSetup setup = setupOf(inputs, *model);
    const FigureSetup traced = tracedOf(setup, "-terms", setup.images.front().recipe.options),
                      weighed = tracedOf(setup, "-environment", environmentOptions(setup));
    section.steps = figureSteps(setup);
    for (const FigureSetup& rays : {traced, weighed}) section.steps.push_back(tracedFigureStep(rays));
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(
            "The paper shows the Buddha in Ashikhmin and Shirley's BRDF (kd 0.5, ks 0.75, nu 10, nv 100) "
            "under a single distant light, and finds four terms visually accurate. Here the first K terms of "
            "the paper's factorisation, maps of 48 x 48; the reference has the analytic BRDF under the same "
            "light, in the texels of 6 x 64². There is no ground, so that the error is that of the "
            "highlights.");
        report.say(quickNote(quick));
        report.say("The terms alone: rays find what the light reaches, and nothing is lost but by the BRDF's "
                   "approximation.");
        report.add(figureOf(traced, results, describe(*model) + ", terms alone"));
        report.say("The same of the factorisation that weighs what light and pixels ask for "
                   "(--factorization environment), in equal-area maps.");
        report.add(figureOf(weighed, results, describe(*model) + ", terms alone, weighed"));
        report.say("As it is relit in the paper's way, from one bake of rows of 96 coefficients. What this "
                   "adds is lost to these: a single direction needs all of them.");
        report.add(figureOf(setup, results, describe(*model) + ", relit"));
        ReportTable table{"figure_2",
                          "Relative RMSE over K",
                          {"terms K", "the paper's terms alone (interval)",
                           "terms weighed by environments alone (interval)", "relit (interval)"},
                          {},
                          ""};
        for (const FigureImage& image : setup.images)
            table.rows.push_back({image.title, textOf(errorOf(traced, results, image.name)),
                                  textOf(errorOf(weighed, results, image.name)),
                                  textOf(errorOf(setup, results, image.name))});
        report.add(std::move(table));
        const auto percentOf = [&](const FigureSetup& rays, const FigureImage& image) {
            return fmt::format("{:.0f} %", 100 * errorOf(rays, results, image.name).value);
        };
        const FigureImage &four = setup.images[2], &most = setup.images.back();
        report.findings.push_back(fmt::format(
            "Figure 2: under a single direction four terms of the paper's factorisation alone leave an error "
            "of {}, of terms weighed by environments {}; {} terms {} and {}.",
            percentOf(traced, four), percentOf(weighed, four), most.relit.terms, percentOf(traced, most),
            percentOf(weighed, most)));
    };
    return section;
}

} // namespace relume
