// Where error comes from: every stage made exact in turn, and what low-order spherical harmonics would leave.
#include "apps/evaluation/expect_no_stop.h"
#include "apps/evaluation/figure_steps.h"
#include "apps/evaluation/range_text.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"
#include "engine/base/progress.h"
#include "precompute/error/heat_maps.h"
#include "precompute/error/study_json.h"

#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr std::array kModels = {"bunny", "dragon", "lucy"};
constexpr std::array kMaterials = {"ashikhmin-shirley", "red-plastic", "clay"};
constexpr std::array kEnvironments = {"grace", "stpeters", "rnl"};
constexpr int kLowOrder = 5;

struct Study {
    std::string name, model, material; // model as the report calls it
    std::vector<SceneInput> lights;
    BakeRecipe recipe;
    bool quick = false;
};

// Of one light: what was drawn, what is true, what harmonics give, and heat.
void writeImages(StepRun& run, const std::string& prefix, const ErrorStudy& study, const ViewPoints& points) {
    constexpr int kScale = 3;
    const float exposure = float(-std::log2(std::max(2 * study.budget.level, 1e-6)));
    run.write(prefix + "drawn", enlarged(study.drawn, kScale), exposure);
    run.write(prefix + "reference", enlarged(study.reference, kScale), exposure);
    run.write(prefix + "harmonics", enlarged(study.lowOrder->image, kScale), exposure);
    for (const HeatMap& heat : heatMaps(study, points, kScale))
        run.writeDisplay(prefix + heat.name, heat.map);
}

nlohmann::ordered_json work(StepRun& run, const Study& study) {
    const Asset asset = run.asset(study.recipe);
    std::vector<StudiedLight> lights;
    for (const SceneInput& input : study.lights) {
        const SceneLight light = environmentLight(input);
        lights.push_back({light.light, light.truth, {}});
    }
    const ImageSize size = study.quick ? ImageSize{64, 48} : ImageSize{120, 90};
    const auto pixels = uint64_t(size.width) * uint64_t(size.height);
    Progress progress("tracing", pixels, "pixels");
    const ErrorStudies studies = studyErrors(run.device, asset, defaultAppearance(asset), lights,
                                             {.view = {orbitOf(asset, size, 30, 15), size.width, size.height},
                                              .mostPasses = study.quick ? 256 : 1024,
                                              .lowOrder = kLowOrder},
                                             [&](double share) {
                                                 expectNoStop();
                                                 progress.update(uint64_t(double(pixels) * share));
                                             });
    nlohmann::ordered_json numbers;
    for (size_t i = 0; i < lights.size(); i++) {
        numbers.push_back(describe(studies.lights[i]));
        writeImages(run, fmt::format("{}-", i), studies.lights[i], studies.points);
    }
    return numbers;
}

std::string percent(double share) { return fmt::format("{:.2f} %", 100 * share); }

double number(const nlohmann::ordered_json& numbers, const char* key) { return numbers.at(key); }

void addTables(const std::vector<Study>& studies, const StepResults& results, ReportSection& report) {
    ReportTable sums{
        "error-sums",
        "How the sources add up",
        {"model", "material", "environment", "measured", "sources, summed", "ratio", "were they independent",
         "reference's noise", "not accounted for"},
        {},
        "Measured: the device's image against the sampled reference. Summed: the changes of all "
        "sources, point by point; independent: the root of the sum of their squares. Not accounted "
        "for: of the reference."};
    ReportTable parts{
        "error-sources",
        "Where error comes from",
        {"model", "material", "environment"},
        {},
        "The change by each source in percent of the truth, root mean square; in brackets its share of "
        "the squared total in percent, below 0 where it makes up for others."};
    for (size_t i = 0; i < kErrorSources; i++) parts.columns.emplace_back(errorSourceTitle(ErrorSource(i)));
    ReportTable harmonics{
        "error-harmonics",
        "Against 25 spherical harmonics",
        {"model", "material", "environment", "relume", "harmonics, same K terms", "harmonics, exact BRDF"},
        {},
        "Harmonics: the environment in those of degrees 0 to 4 alone; shadows exact, nothing "
        "interpolated or stored; of relume's K terms, and of the exact BRDF."};
    for (const Study& study : studies)
        for (size_t i = 0; i < study.lights.size(); i++) {
            const auto& numbers = results.at(study.name).numbers.at(i);
            const std::vector<std::string> scene = {study.model, study.material, study.lights[i].name};
            const double measured = number(numbers, "measured"), total = number(numbers, "total");
            std::vector<std::string> row = scene;
            for (const std::string& cell :
                 {percent(measured), percent(total),
                  measured > 0 ? fmt::format("{:.3f}", total / measured) : "-",
                  percent(number(numbers, "root_sum_of_squares")),
                  percent(number(numbers, "reference_noise")), percent(number(numbers, "unexplained_truth"))})
                row.push_back(cell);
            sums.rows.push_back(row);
            row = scene;
            for (const auto& source : numbers.at("sources"))
                row.push_back(fmt::format("{:.2f}\u00a0({:.0f})", 100 * number(source, "rms"),
                                          std::round(100 * number(source, "share")) + 0.0));
            parts.rows.push_back(row);
            row = scene;
            for (const char* key : {"measured", "spherical_harmonics_of_terms", "spherical_harmonics"})
                row.push_back(percent(number(numbers, key)));
            harmonics.rows.push_back(row);
        }
    report.add(std::move(sums));
    report.add(std::move(parts));
    report.add(std::move(harmonics));
}

void addFindings(const std::vector<Study>& studies, const StepResults& results, ReportSection& report) {
    std::vector<double> sums, harmonics;
    double mean = 0, worst = 1;
    for (const Study& study : studies)
        for (size_t i = 0; i < study.lights.size(); i++) {
            const auto& numbers = results.at(study.name).numbers.at(i);
            const double measured = number(numbers, "measured");
            if (!(measured > 0)) continue;
            sums.push_back(number(numbers, "total") / measured);
            harmonics.push_back(number(numbers, "spherical_harmonics_of_terms") / measured);
            mean += sums.back();
            if (std::abs(sums.back() - 1) > std::abs(worst - 1)) worst = sums.back();
        }
    if (sums.empty()) return;
    report.findings.push_back(fmt::format(
        "Sources of error: over {} scenes their sum is {:.3f} of the measured error in the mean, and "
        "{:.3f} where it is furthest from 1. 25 spherical harmonics with the same terms leave {} times "
        "relume's error.",
        sums.size(), mean / double(sums.size()), worst, rangeText(harmonics)));
}

ReportFigure heatFigure(const Study& study, size_t light) {
    const auto picture = [&](const std::string& name, const std::string& title) {
        return Picture{pictureOf(study.name, fmt::format("{}-{}.png", light, name)), title, ""};
    };
    ReportFigure figure{
        fmt::format("{}, {}, {}", study.model, study.material, describe(study.lights[light])),
        5,
        {picture("drawn", "drawn"), picture("reference", "reference"),
         picture("harmonics", "25 spherical harmonics"), picture("total", "all error")},
        "Full heat is the total error that one point in a hundred exceeds, in all maps alike."};
    for (size_t i = 0; i < kErrorSources; i++)
        figure.pictures.push_back(picture(std::string(errorSourceName(ErrorSource(i))),
                                          std::string(errorSourceTitle(ErrorSource(i)))));
    return figure;
}

} // namespace

Section errorSources(const SectionInputs& inputs) {
    Section section{"sources", "Where error comes from", {}, {}};
    const std::vector<SceneInput> lights = environmentsOf(inputs, kEnvironments);
    std::vector<Study> studies;
    for (const char* name : kModels) {
        if (inputs.quick && name != kModels.front()) break;
        const auto model = inputs.scenes.model(name);
        if (!model || lights.empty()) continue;
        for (const char* material : kMaterials)
            studies.push_back({fmt::format("sources-{}-{}", name, material), describe(*model), material,
                               lights, sceneRecipe(inputs, name, *model, material, {}), inputs.quick});
    }
    if (studies.empty())
        return skippedSection(std::move(section), "there is none of its models and environments");
    for (const Study& study : studies) {
        Step step{.name = study.name,
                  .title = fmt::format("Sources of error: {}, {}", study.model, study.material),
                  .seconds = inputs.quick ? 40.0 : 240.0,
                  .bakes = {study.recipe},
                  .work = [study](StepRun& run) { return work(run, study); }};
        for (const SceneInput& light : lights) step.inputs.push_back(light.hash);
        section.steps.push_back(std::move(step));
    }
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(
            "Each point of an image is computed again, stage after stage made exact: first with light that "
            "nothing shadows summed instead of looked up in lit spheres, then with all of the light's "
            "coefficients, then transport as it was before it was stored, then all its coefficients, "
            "its own instead of its triangle's corners', all terms of the tabulated BRDF, the BRDF itself, "
            "taken as finely as rays are cast, the light's own resolution, the full mesh, and 6 x 512² rays. "
            "What a stage changes is the error of what it replaces. Baked with relume's defaults.");
        report.say(quickNote(quick));
        addTables(studies, results, report);
        addFindings(studies, results, report);
        for (const Study& study : studies) report.add(heatFigure(study, 0));
    };
    return section;
}

} // namespace relume
