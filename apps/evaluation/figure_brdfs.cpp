// Figure 4: BRDFs factored, their maps, their errors, and what they look like.
#include "apps/evaluation/expect_no_stop.h"
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"
#include "apps/plot/line_plot.h"
#include "apps/plot/map_sheet.h"
#include "precompute/brdf/factorization_error.h"

#include <array>
#include <fmt/format.h>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

struct FigureBrdf {
    const char *material, *title, *environment;
};
constexpr std::array kBrdfs = {
    FigureBrdf{"ashikhmin-shirley", "Ashikhmin-Shirley", "grace"},
    FigureBrdf{"brown-plastic", "light brown plastic", "rnl"},
    FigureBrdf{"clay", "clay (Lafortune)", "stpeters"},
    FigureBrdf{"skin", "dark skin (Lafortune)", "grace"},
};
constexpr std::array kSizes = {16, 32, 48, 64};
constexpr int kSheetSize = 48;

std::string stepName(const FigureBrdf& brdf) { return fmt::format("figure-4-{}", brdf.material); }

Json measure(StepRun& run, const FigureBrdf& wanted, int terms) {
    const std::unique_ptr<Brdf> brdf = makeBrdf(wanted.material);
    Json numbers;
    for (const int size : kSizes) {
        expectNoStop();
        const FactoredBrdf factored = factorize(tabulate(*brdf, size, DiskMapping::Orthographic),
                                                {.terms = terms, .method = Factorization::Paper});
        numbers[fmt::format("{}", size)] = rmsErrors(*brdf, factored).absolute;
        if (size == kSheetSize) run.writeDisplay("maps", drawMapSheet(factored));
    }
    return numbers;
}

std::string plotOf(const StepResults& results, int terms) {
    LinePlot plot{.title = "RMS error, weighted by cosines",
                  .xLabel = "terms K",
                  .yLabel = "RMS of f cos cos",
                  .xTicks = {},
                  .logarithmic = true,
                  .columns = int(kBrdfs.size()),
                  .panels = {}};
    for (int tick = 0; tick <= terms; tick += terms / 4) plot.xTicks.push_back(tick);
    for (const FigureBrdf& brdf : kBrdfs) {
        PlotPanel& panel = plot.panels.emplace_back(PlotPanel{brdf.title, {}});
        for (size_t s = 0; s < kSizes.size(); s++) {
            const auto errors = results.at(stepName(brdf))
                                    .numbers.at(fmt::format("{}", kSizes[s]))
                                    .get<std::vector<double>>();
            PlotCurve curve{fmt::format("S = {}", kSizes[s]), s, false, {}};
            for (size_t k = 0; k < errors.size(); k++) curve.points.emplace_back(double(k + 1), errors[k]);
            panel.curves.push_back(std::move(curve));
        }
    }
    return drawLinePlot(plot);
}

ReportTable tableOf(const StepResults& results, int terms) {
    ReportTable table{
        "figure_4",
        "RMS of f cos θi cos θo over K and S",
        {"BRDF", "S"},
        {},
        "Of 80,000 random pairs of directions, mean over colour channels. The paper plots such curves "
        "weighted by cos θi, without numbers; and sees that beyond S = 32 little is gained."};
    for (int k = 1; k <= terms; k *= 2) table.columns.push_back(fmt::format("K = {}", k));
    for (const FigureBrdf& brdf : kBrdfs)
        for (const int size : kSizes) {
            const Json& errors = results.at(stepName(brdf)).numbers.at(fmt::format("{}", size));
            std::vector<std::string> row = {brdf.title, fmt::format("{}", size)};
            for (int k = 1; k <= terms; k *= 2)
                row.push_back(
                    fmt::format("{:.4f}", errors.at(std::min(size_t(k), errors.size()) - 1).get<double>()));
            table.rows.push_back(std::move(row));
        }
    return table;
}

std::vector<FigureSetup> bunniesOf(const SectionInputs& inputs) {
    std::vector<FigureSetup> bunnies;
    const auto model = inputs.scenes.model("bunny");
    if (!model) return bunnies;
    for (const FigureBrdf& brdf : kBrdfs) {
        const auto light = inputs.scenes.environment(brdf.environment);
        if (!light) continue;
        BakeRecipe recipe = sceneRecipe(inputs, "bunny", *model, brdf.material, paperOptions(4));
        recipe.ground.reset();
        bunnies.push_back({.name = fmt::format("figure-4-bunny-{}", brdf.material),
                           .title = fmt::format("Figure 4: {} bunny under {}", brdf.title, describe(*light)),
                           .size = wideImage(inputs.quick),
                           .azimuth = -20,
                           .elevation = 12,
                           .light = environmentChoice(*light),
                           .images = {{"k4", "K = 4", recipe, {}}},
                           .effort = referenceEffort(inputs.quick),
                           .seconds = inputs.quick ? 5.0 : 60.0});
    }
    return bunnies;
}

} // namespace

Section brdfFigure(const SectionInputs& inputs) {
    Section section{"figure-4", "Figure 4: BRDFs factored", {}, {}};
    const int terms = inputs.quick ? 16 : 32;
    for (const FigureBrdf& brdf : kBrdfs)
        section.steps.push_back({.name = stepName(brdf),
                                 .title = fmt::format("Figure 4: {}", brdf.title),
                                 .seconds = inputs.quick ? 8.0 : 20.0,
                                 .inputs = {{"terms", terms}},
                                 .work = [=](StepRun& run) { return measure(run, brdf, terms); }});
    const std::vector<FigureSetup> bunnies = bunniesOf(inputs);
    for (const FigureSetup& bunny : bunnies)
        for (Step& step : figureSteps(bunny)) section.steps.push_back(std::move(step));
    section.write = [=](const StepResults& results, ReportSection& report) {
        report.say(fmt::format(
            "The first eight light maps (S = {}) of the paper's four BRDFs in its factorisation: each "
            "scaled by its own largest magnitude, magenta where negative. The two Lafortune fits are "
            "the paper's kind; the plastics are ours, as the paper does not give its parameters.",
            kSheetSize));
        ReportFigure sheets{"First eight terms", 2, {}, ""};
        for (const FigureBrdf& brdf : kBrdfs)
            sheets.pictures.push_back({pictureOf(stepName(brdf), "maps.png"), brdf.title, ""});
        report.add(std::move(sheets));
        report.add(ReportPlot{"figure_4", "RMS over the number of terms", plotOf(results, terms)});
        report.add(tableOf(results, terms));
        report.say("Where a larger S does worse: f grows steeply towards grazing angles, how near to the "
                   "horizon the "
                   "outermost centres of a map fall is a matter of chance, and at S = 64 the first terms of "
                   "Ashikhmin-Shirley describe these.");
        for (const FigureSetup& bunny : bunnies) report.add(figureOf(bunny, results, bunny.title));
    };
    return section;
}

} // namespace relume
