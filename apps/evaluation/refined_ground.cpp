// Vertices where shadows end: refined grounds against uniform ones.
#include "apps/evaluation/expect_no_stop.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"
#include "engine/base/progress.h"
#include "precompute/error/error_study.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr std::array kUniform = {37, 74, 148};                     // quads a side
constexpr std::array kRefined = {0.014, 0.01, 0.0085, 0.007};      // --refine
constexpr std::array kEnvironments = {"rnl", "grace", "stpeters"}; // from broad to small

struct Ground {
    std::string step, title;
    BakeRecipe recipe;
};

// Of the points that a part shows: what interpolation changes, relative to what is true there.
double interpolationError(const ErrorStudies& studies, size_t light, size_t part) {
    std::vector<StageRadiance> own;
    for (size_t i = 0; i < studies.points.hits.size(); i++)
        if (studies.points.hits[i].mesh == part) own.push_back(studies.lights[light].stages[i]);
    return errorBudget(own).sources[size_t(ErrorSource::Interpolation)].rms;
}

nlohmann::ordered_json study(StepRun& run, const Ground& ground, const std::vector<SceneInput>& inputs,
                             bool quick) {
    const Asset asset = run.asset(ground.recipe);
    std::vector<StudiedLight> lights;
    for (const SceneInput& input : inputs) {
        const SceneLight light = environmentLight(input);
        lights.push_back({light.light, light.truth, {}});
    }
    const ImageSize size = quick ? ImageSize{56, 42} : ImageSize{120, 90};
    const auto pixels = uint64_t(size.width) * uint64_t(size.height);
    Progress progress("tracing", pixels, "pixels");
    // References are for whole images: here only what interpolation changes is asked for.
    const ErrorStudies studies =
        studyErrors(run.device, asset, defaultAppearance(asset), lights,
                    {.view = {orbitOf(asset, size, 30, 25), size.width, size.height}, .mostPasses = 0},
                    [&](double share) {
                        expectNoStop();
                        progress.update(uint64_t(double(pixels) * share));
                    });
    nlohmann::ordered_json numbers = {{"vertices", asset.parts.back().mesh.vertexCount()}};
    for (size_t i = 0; i < lights.size(); i++)
        numbers["errors"].push_back(interpolationError(studies, i, asset.parts.size() - 1));
    return numbers;
}

std::vector<Ground> grounds(const SectionInputs& inputs, const SceneInput& model) {
    BakeOptions options = paperOptions(1);
    std::vector<Ground> grounds;
    for (const int quads : kUniform) {
        BakeRecipe recipe = sceneRecipe(inputs, "bunny", model, "white-diffuse", options);
        recipe.ground->tessellation = quads;
        grounds.push_back(
            {fmt::format("refinement-uniform-{}", quads), fmt::format("{0} x {0} quads", quads), recipe});
    }
    for (const double wanted : kRefined) {
        options.refinement = RefinementRecord{.wanted = wanted};
        BakeRecipe recipe = sceneRecipe(inputs, "bunny", model, "white-diffuse", options);
        recipe.ground->tessellation = kRefinedGroundQuads;
        grounds.push_back(
            {fmt::format("refinement-{:.0f}", 1e4 * wanted), fmt::format("--refine {}", wanted), recipe});
    }
    return grounds;
}

// The fewest vertices that are as good as the finest uniform ground's under every light.
std::string finding(const std::vector<Ground>& all, const StepResults& results) {
    const auto errorsOf = [&](const Ground& ground) -> std::vector<double> {
        return results.at(ground.step).numbers.at("errors");
    };
    const auto verticesOf = [&](const Ground& ground) -> uint64_t {
        return results.at(ground.step).numbers.at("vertices");
    };
    const Ground& uniform = all[kUniform.size() - 1];
    const Ground* best = nullptr;
    for (size_t i = kUniform.size(); i < all.size(); i++) {
        const std::vector<double> own = errorsOf(all[i]), theirs = errorsOf(uniform);
        const bool isAsGood = std::ranges::equal(own, theirs, std::less_equal());
        if (isAsGood && (!best || verticesOf(all[i]) < verticesOf(*best))) best = &all[i];
    }
    if (!best)
        return fmt::format("Refinement: none of the refined grounds is as good as {} under every light.",
                           uniform.title);
    return fmt::format("Refinement: {} vertices ({}) interpolate the ground as well as {} uniform ones under "
                       "every light: {:.1f} times fewer.",
                       verticesOf(*best), best->title, verticesOf(uniform),
                       double(verticesOf(uniform)) / double(verticesOf(*best)));
}

} // namespace

Section refinedGround(const SectionInputs& inputs) {
    Section section{"refinement", "Vertices where shadows end", {}, {}};
    const auto model = inputs.scenes.model("bunny");
    const std::vector<SceneInput> lights = environmentsOf(inputs, kEnvironments);
    if (!model || lights.empty())
        return skippedSection(std::move(section), "there is no bunny, or none of its environments");
    const std::vector<Ground> all = grounds(inputs, *model);
    for (const Ground& ground : all) {
        Step step{
            .name = ground.step,
            .title = fmt::format("Refinement: the bunny's ground, {}", ground.title),
            .seconds = inputs.quick ? 10.0 : 120.0,
            .bakes = {ground.recipe},
            .work = [=, quick = inputs.quick](StepRun& run) { return study(run, ground, lights, quick); }};
        for (const SceneInput& light : lights) step.inputs.push_back(light.hash);
        section.steps.push_back(std::move(step));
    }
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(
            "The bunny, white-diffuse like its ground: what interpolation between vertices changes of the "
            "ground's points in an image, relative root mean square (the source \"vertex interpolation\" "
            "of the ground alone). Uniform grounds, and grounds that were refined to an error over the "
            "whole scene, from 16 x 16 quads on.");
        if (quick) report.say("With --quick the bunny has fewer triangles, and visibility 6 x 128².");
        ReportTable table{"refinement", "Vertices against error", {"ground", "its vertices"}, {}, ""};
        for (const SceneInput& light : lights) table.columns.push_back(describe(light));
        for (const Ground& ground : all) {
            const auto& numbers = results.at(ground.step).numbers;
            std::vector<std::string> row = {ground.title,
                                            fmt::format("{}", numbers.at("vertices").get<uint64_t>())};
            for (const auto& error : numbers.at("errors"))
                row.push_back(fmt::format("{:.2f} %", 100 * error.get<double>()));
            table.rows.push_back(std::move(row));
        }
        report.findings.push_back(finding(all, results));
        report.add(std::move(table));
    };
    return section;
}

} // namespace relume
