// Table 2: what a change of view and of light takes.
#include "apps/bench/median.h"
#include "apps/bench/view_bench.h"
#include "apps/evaluation/expect_no_stop.h"
#include "apps/evaluation/paper_models.h"
#include "apps/evaluation/range_text.h"
#include "apps/evaluation/sections.h"
#include "precompute/layout/conversion.h"

#include <fmt/format.h>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<ImageSize, 2> kSizes = {ImageSize{640, 480}, ImageSize{1280, 720}};
constexpr std::array kVariants = {"k1", "k4", "k4-bases"};

std::vector<Asset> variantsOf(StepRun& run, const std::vector<BakeRecipe>& recipes) {
    std::vector<Asset> assets;
    for (const BakeRecipe& recipe : recipes) assets.push_back(run.asset(recipe));
    assets.push_back(assets.back());
    convertLayout(assets.back(), {}, [](uint64_t, uint64_t) { expectNoStop(); });
    return assets;
}

Json measure(StepRun& run, const std::vector<BakeRecipe>& recipes, const SceneInput& light, int rounds) {
    const std::vector<Asset> assets = variantsOf(run, recipes);
    const SceneLight source = environmentLight(light);
    Json numbers;
    for (const ImageSize size : kSizes) {
        expectNoStop();
        // As relume render --preset paper has it, for bases too.
        ViewRounds options{.count = rounds,
                           .selection = {.threshold = kPaperLightThreshold},
                           .width = size.width,
                           .height = size.height,
                           .residual = false,
                           .camera = {}};
        options.camera = [size](const Asset& asset, float turn) {
            return orbitOf(asset, size, 30 + glm::degrees(turn), 20);
        };
        const auto series = benchView(run.device, assets, source.light, options, true);
        Json& own = numbers[fmt::format("{}x{}", size.width, size.height)];
        for (size_t i = 0; i < series.size(); i++)
            own[kVariants[i]] = {{"view_ms", median(series[i].viewMs)},
                                 {"light_ms", median(series[i].lightMs)}};
        numbers["light_coefficients"] = median(series.front().lightCoefficients);
    }
    return numbers;
}

std::string stepName(const PaperScene& scene) { return fmt::format("table-2-{}", scene.model->name); }

std::string digits(double value) { return fmt::format("{:.3g}", value); }

// How many times the paper's rates at K = 4.
std::string finding(const std::vector<PaperScene>& scenes, const StepResults& results) {
    const auto& [width, height] = kSizes.front();
    const auto against = [&](const char* variant) {
        std::vector<double> view, light;
        for (const PaperScene& scene : scenes) {
            const Json& times =
                results.at(stepName(scene)).numbers.at(fmt::format("{}x{}", width, height)).at(variant);
            view.push_back(1000 / times.at("view_ms").get<double>() / scene.model->viewFps[1]);
            light.push_back(1000 / times.at("light_ms").get<double>() / scene.model->lightFps[1]);
        }
        return fmt::format("{} times the paper's changes of view a second and {} times those of light",
                           rangeText(view), rangeText(light));
    };
    return fmt::format("Table 2: at K = 4 and {} x {}, rows give {}; bases {}.", width, height, against("k4"),
                       against("k4-bases"));
}

void addRows(ReportTable& table, const PaperScene& scene, const Json& numbers) {
    for (const ImageSize size : kSizes) {
        const Json& own = numbers.at(fmt::format("{}x{}", size.width, size.height));
        for (size_t which = 0; which < kVariants.size(); which++) {
            const Json& times = own.at(kVariants[which]);
            const size_t paper = std::min<size_t>(which, 1);
            const double view = times.at("view_ms"), light = times.at("light_ms");
            table.rows.push_back({scene.input.name, fmt::format("{}", kPaperTerms[paper]),
                                  which == 2 ? "bases" : "rows",
                                  fmt::format("{} x {}", size.width, size.height), digits(view),
                                  digits(1000 / view), digits(scene.model->viewFps[paper]), digits(light),
                                  digits(1000 / light), digits(scene.model->lightFps[paper])});
        }
    }
}

} // namespace

Section frameTable(const SectionInputs& inputs) {
    Section section{"table-2", "Table 2: view and light changes", {}, {}};
    const std::vector<PaperScene> scenes = paperScenes(inputs);
    auto light = inputs.scenes.environment("grace");
    if (!light) light = inputs.scenes.anyEnvironment();
    if (scenes.empty() || !light)
        return skippedSection(std::move(section), "there is no model or no environment");
    for (const PaperScene& scene : scenes) {
        std::vector<BakeRecipe> recipes;
        for (const int terms : kPaperTerms) recipes.push_back(paperRecipe(inputs, scene, terms));
        const int rounds = inputs.quick ? 5 : 15;
        section.steps.push_back(
            {.name = stepName(scene),
             .title = fmt::format("Table 2: {}", scene.input.name),
             .seconds = inputs.quick ? 15.0 : 60.0,
             .inputs = {{"light", light->hash}, {"rounds", rounds}},
             .bakes = recipes,
             .work = [=, light = *light](StepRun& run) { return measure(run, recipes, light, rounds); }});
    }
    section.write = [=, light = *light, quick = inputs.quick](const StepResults& results,
                                                              ReportSection& report) {
        report.say(fmt::format(
            "Wall-clock medians under {}, turned by a degree from image to image, with the paper's light "
            "threshold of 1024, one sample a pixel and no residual. A view change draws the object anew; a "
            "light change samples, "
            "transforms and quantises the light, relights every vertex in full, and draws.",
            describe(light)));
        report.say(quickNote(quick));
        ReportTable table{
            "table_2",
            "View and light changes",
            {"model", "K", "layout", "image", "view change, ms", "view change, fps",
             "paper's view change, fps", "light change, ms", "light change, fps",
             "paper's light change, fps"},
            {},
            "The paper's machine was a Pentium 4 of 2.6 GHz with a GeForce 5900; the size of its images "
            "is not known. Its bunny has 36,000 vertices, Buddha 56,000, dragon 100,000 and Lucy "
            "180,000; Table 1 has the numbers of ours."};
        for (const PaperScene& scene : scenes) addRows(table, scene, results.at(stepName(scene)).numbers);
        report.add(std::move(table));
        report.findings.push_back(finding(scenes, results));
    };
    return section;
}

} // namespace relume
