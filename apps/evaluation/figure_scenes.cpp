// Figures 1, 6 and 7: scenes in the light of environments and of a small lamp.
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/range_text.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"

#include <fmt/format.h>

namespace relume {

namespace {

struct PaperPicture {
    const char *name, *title, *model, *material;
    const char* environment; // null: a small area light
    float azimuth = 30, elevation = 15;
    bool isTall = false;
    const char* instead = nullptr; // the environment that is used where that one is missing
};

constexpr std::array kPictures = {
    PaperPicture{"dragon", "Figure 1, left: dragon, Ashikhmin-Shirley", "dragon", kAshikhminShirley, "uffizi",
                 -20, 15, false, "grace"},
    PaperPicture{"bunny", "Figure 1, right: bunny, red plastic", "bunny", "red-plastic", "grace", -20, 15},
    PaperPicture{"buddha", "Figure 6, left: Buddha, Ashikhmin-Shirley", "buddha", kAshikhminShirley,
                 "stpeters", 0, 15, true},
    PaperPicture{"lucy-area", "Figure 6, right: Lucy, Ashikhmin-Shirley", "lucy", kAshikhminShirley, nullptr,
                 30, 15, true},
    PaperPicture{"lucy-brown", "Figure 7: Lucy, light brown plastic", "lucy", "brown-plastic", "rnl", 30, 15,
                 true},
};

struct Shot {
    std::string title, remark;
    FigureSetup setup;
};

// What `relume bake` makes if asked for nothing.
BakeOptions usualOptions() { return {}; }

std::optional<Shot> shotOf(const SectionInputs& inputs, const PaperPicture& picture) {
    const auto model = inputs.scenes.model(picture.model);
    Shot shot{picture.title, "", {}};
    std::string lightName = "a small area light of 3 degrees' radius";
    LightChoice light = areaChoice(75, 35, 3);
    if (picture.environment) {
        auto found = inputs.scenes.environment(picture.environment);
        if (!found && picture.instead) {
            found = inputs.scenes.environment(picture.instead);
            shot.remark = "Not the paper's light, which is missing.";
        }
        if (!found) return std::nullopt;
        light = environmentChoice(*found);
        lightName = describe(*found);
    }
    if (!model) return std::nullopt;
    shot.title += fmt::format(", under {}", lightName);
    if (!model->standsFor.empty()) shot.remark += fmt::format(" {}.", describe(*model));
    const auto recipe = [&](const BakeOptions& options) {
        return sceneRecipe(inputs, picture.model, *model, picture.material, options);
    };
    shot.setup = {.name = fmt::format("scenes-{}", picture.name),
                  .title = picture.title,
                  .size = picture.isTall ? tallImage(inputs.quick) : wideImage(inputs.quick),
                  .azimuth = picture.azimuth,
                  .elevation = picture.elevation,
                  .distance = 1.1f,
                  .light = light,
                  .images = {{"paper",
                              "the paper's way",
                              recipe(paperOptions(4)),
                              {.selection = {.threshold = kPaperLightThreshold}}},
                             {"usual", "relume's defaults", recipe(usualOptions()), {}}},
                  .effort = referenceEffort(inputs.quick),
                  .seconds = inputs.quick ? 5.0 : 120.0};
    return shot;
}

void addComparison(ReportTable& table, const Shot& shot, const StepResults& results) {
    const MeasuredError paper = errorOf(shot.setup, results, "paper"),
                        usual = errorOf(shot.setup, results, "usual");
    const char* verdict = !areDistinguishable(paper, usual) ? "not distinguishable"
                          : paper.value < usual.value       ? "the paper's way is closer"
                                                            : "the defaults are closer";
    table.rows.push_back({shot.title, textOf(paper), textOf(usual), verdict});
}

std::string finding(const std::vector<Shot>& shots, const StepResults& results) {
    std::vector<double> papers, usuals;
    int paperCloser = 0, usualCloser = 0;
    for (const Shot& shot : shots) {
        const MeasuredError paper = errorOf(shot.setup, results, "paper"),
                            usual = errorOf(shot.setup, results, "usual");
        papers.push_back(100 * paper.value);
        usuals.push_back(100 * usual.value);
        if (areDistinguishable(paper, usual)) (paper.value < usual.value ? paperCloser : usualCloser)++;
    }
    return fmt::format(
        "Figures 1, 6 and 7: the paper's way leaves errors of {} %, relume's defaults {} %. Of {} scenes "
        "the defaults are closer to the reference in {}, the paper's way in {}.",
        rangeText(papers), rangeText(usuals), shots.size(), usualCloser, paperCloser);
}

} // namespace

Section sceneFigures(const SectionInputs& inputs) {
    Section section{"scenes", "Figures 1, 6 and 7: scenes under all-frequency light", {}, {}};
    std::vector<Shot> shots;
    for (const PaperPicture& picture : kPictures)
        if (auto shot = shotOf(inputs, picture)) shots.push_back(std::move(*shot));
    if (shots.empty())
        return skippedSection(std::move(section), "there is none of its models and environments");
    for (const Shot& shot : shots)
        for (Step& step : figureSteps(shot.setup)) section.steps.push_back(std::move(step));
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(
            "Each in the paper's way (its factorisation, K = 4, rows of 96 coefficients, the light above its "
            "threshold of 1024), as relume bakes and renders it if asked for nothing (K = 4, bases, 512 "
            "coefficients of the light), and the reference: exact BRDF, full mesh, light of 6 x 256² "
            "texels.");
        report.say(quickNote(quick));
        ReportTable table{"scenes", "Relative RMSE", {"scene", "the paper's way", "defaults", ""}, {}, ""};
        for (const Shot& shot : shots) {
            ReportFigure figure = figureOf(shot.setup, results, shot.title);
            if (!shot.remark.empty()) figure.note = shot.remark + " " + figure.note;
            report.add(std::move(figure));
            addComparison(table, shot, results);
        }
        report.add(std::move(table));
        report.findings.push_back(finding(shots, results));
    };
    return section;
}

} // namespace relume
