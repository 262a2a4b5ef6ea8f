// Table 1: what a bake takes.
#include "apps/evaluation/expect_no_stop.h"
#include "apps/evaluation/paper_models.h"
#include "apps/evaluation/range_text.h"
#include "apps/evaluation/scene_setup.h"
#include "apps/evaluation/sections.h"
#include "precompute/layout/conversion.h"

#include <fmt/format.h>

namespace relume {

namespace {

using Json = nlohmann::ordered_json;

// Bytes a vertex of this bake in the layout that `relume bake` gives if not asked for another.
double basesBytes(Asset asset) {
    const auto progress = [](uint64_t, uint64_t) { expectNoStop(); };
    const Conversion conversion = convertLayout(asset, {}, progress);
    return double(conversion.bytesAfter) / double(verticesOf(asset));
}

Json measure(StepRun& run, const BakeRecipe& recipe, bool converts) {
    const BakeRecord record = run.timedBake(recipe);
    Json numbers = {{"vertices", record.vertices},
                    {"ms_per_vertex", *record.msPerVertex},
                    {"bytes_per_vertex", double(record.bytes) / double(record.vertices)}};
    for (const auto& [stage, ms] : record.msByStage) numbers["stages"][stage] = ms;
    if (converts) numbers["bases_bytes_per_vertex"] = basesBytes(run.asset(recipe));
    return numbers;
}

std::string stepName(const PaperModel& model, int terms) {
    return fmt::format("table-1-{}-k{}", model.name, terms);
}

// Ours and the paper's, of one bake.
struct Cost {
    double vertices, ms, bytes;         // ms, bytes: per vertex
    double paperMs, paperBytes;         // per vertex of its own model
    std::optional<double> basesBytes{}; // of the same transport
};

Cost costOf(const PaperModel& model, size_t which, const StepResults& results) {
    const Json& numbers = results.at(stepName(model, kPaperTerms[which])).numbers;
    Cost cost{.vertices = numbers.at("vertices"),
              .ms = numbers.at("ms_per_vertex"),
              .bytes = numbers.at("bytes_per_vertex"),
              .paperMs = model.minutes[which] * 60e3 / model.allVertices(),
              .paperBytes = model.megabytes[which] * 1e6 / model.allVertices()};
    if (numbers.contains("bases_bytes_per_vertex"))
        cost.basesBytes = numbers.at("bases_bytes_per_vertex").get<double>();
    return cost;
}

std::string finding(const std::vector<PaperScene>& scenes, const StepResults& results) {
    std::vector<double> ms, speed, rows, bases;
    for (const PaperScene& scene : scenes)
        for (size_t which = 0; which < 2; which++) {
            const Cost cost = costOf(*scene.model, which, results);
            ms.push_back(cost.ms);
            speed.push_back(cost.paperMs / cost.ms);
            rows.push_back(cost.bytes / cost.paperBytes);
            if (cost.basesBytes) bases.push_back(*cost.basesBytes / cost.paperBytes);
        }
    return fmt::format(
        "Table 1: bakes in the paper's way take {} ms a vertex, {} times faster than on its machine of "
        "2004, and {} times its bytes a vertex; kept in bases, {} times.",
        rangeText(ms), rangeText(speed), rangeText(rows), rangeText(bases));
}

void addRow(ReportTable& table, const PaperScene& scene, size_t which, const StepResults& results) {
    const PaperModel& model = *scene.model;
    const int terms = kPaperTerms[which];
    const Cost cost = costOf(model, which, results);
    table.rows.push_back({scene.input.name, fmt::format("{}", terms), fmt::format("{:.0f}", cost.vertices),
                          fmt::format("{:.0f}", model.allVertices()), fmt::format("{:.3g}", cost.ms),
                          fmt::format("{:.3g}", cost.paperMs), fmt::format("{:.0f}", model.minutes[which]),
                          fmt::format("{:.0f}", cost.paperMs / cost.ms), fmt::format("{:.0f}", cost.bytes),
                          fmt::format("{:.0f}", cost.paperBytes),
                          fmt::format("{:.0f}", model.megabytes[which]),
                          cost.basesBytes ? fmt::format("{:.0f}", *cost.basesBytes) : "-"});
}

// Adds a table of the device time of a vertex, stage by stage.
void addStages(const std::vector<PaperScene>& scenes, const StepResults& results, ReportSection& report) {
    ReportTable table{
        "table_1_stages",
        "Milliseconds of a vertex, by stages",
        {"model with ground", "K"},
        {},
        "As the device's clock has them; the rest of Table 1's times is the host's and waiting."};
    const Json stages = results.at(stepName(*scenes.front().model, kPaperTerms.back()))
                            .numbers.value("stages", Json::object());
    for (const auto& [stage, ms] : stages.items()) table.columns.push_back(stage);
    for (const PaperScene& scene : scenes)
        for (const int terms : kPaperTerms) {
            const Json own =
                results.at(stepName(*scene.model, terms)).numbers.value("stages", Json::object());
            std::vector<std::string> row = {scene.input.name, fmt::format("{}", terms)};
            for (const auto& [stage, ms] : stages.items())
                row.push_back(own.contains(stage) ? fmt::format("{:.3f}", own[stage].get<double>()) : "-");
            table.rows.push_back(std::move(row));
        }
    report.add(std::move(table));
}

} // namespace

Section bakeTable(const SectionInputs& inputs) {
    Section section{"table-1", "Table 1: bake time and size", {}, {}};
    const std::vector<PaperScene> scenes = paperScenes(inputs);
    if (scenes.empty()) return skippedSection(std::move(section), "there are no models");
    for (const PaperScene& scene : scenes)
        for (size_t which = 0; which < 2; which++) {
            const int terms = kPaperTerms[which];
            const BakeRecipe recipe = paperRecipe(inputs, scene, terms);
            section.steps.push_back({.name = stepName(*scene.model, terms),
                                     .title = fmt::format("Table 1: {}, K = {}", scene.input.name, terms),
                                     .seconds = inputs.quick ? 4.0 : 1e-3 * scene.model->allVertices(),
                                     .bakes = {recipe},
                                     .work = [=](StepRun& run) { return measure(run, recipe, terms == 4); }});
        }
    section.write = [=, quick = inputs.quick](const StepResults& results, ReportSection& report) {
        report.say(fmt::format(
            "Bakes in the paper's way (relume bake --preset paper): Ashikhmin-Shirley on the object, white "
            "diffuse on the ground (one term), the paper's factorisation, maps of 48 x 48, visibility drawn "
            "at 6 x 256² from a model simplified to {} triangles, the BRDF at every texel of it, rows of 96 "
            "coefficients. How far the paper simplifies is not known; its models and ours differ in their "
            "numbers of vertices, so that times and bytes are compared by the vertex.",
            paperOptions(1).occluderTriangles));
        report.say(quickNote(quick));
        ReportTable table{
            "table_1",
            "Bake time and size",
            {"model with ground", "K", "vertices", "paper's vertices", "ms per vertex",
             "paper's ms per vertex", "paper's minutes", "times faster", "bytes per vertex",
             "paper's bytes per vertex", "paper's MB", "bytes per vertex in bases"},
            {},
            "The paper's machine was a Pentium 4 of 2.6 GHz with a GeForce 5900. Bytes are of transport, "
            "in memory. In bases: the same transport in the layout that relume bake gives if not asked "
            "for another."};
        for (const PaperScene& scene : scenes)
            for (size_t which = 0; which < 2; which++) addRow(table, scene, which, results);
        report.add(std::move(table));
        addStages(scenes, results, report);
        report.findings.push_back(finding(scenes, results));
    };
    return section;
}

} // namespace relume
