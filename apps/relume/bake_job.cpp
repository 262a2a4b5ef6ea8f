#include "apps/relume/bake_job.h"

#include "apps/relume/bake_report.h"
#include "apps/relume/scene_arguments.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/interrupt.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace relume {

// Rejects sizes of 0, which would mean no limit, and negative ones, which would wrap.
static std::string isPositive(const std::string& text) {
    return std::atof(text.c_str()) > 0 ? ""
                                       : fmt::format("expected a size as 512M or 2G, found \"{}\"", text);
}

void BakeJob::add(CLI::App& command) {
    command.add_option("-o,--output", output, "Bake to write (.relume)")->type_name("FILE")->required();
    command.add_flag("--keep-visibility", keepVisibility,
                     "Keep visibility in the file, some hundred bytes a vertex, for `relume rebake`");
    device.add(command);
    command.add_option("--timings", mTimings, "Write stage timings as JSON")->type_name("FILE");
    command
        .add_option("--memory", limits.memory,
                    "Most memory that a batch of vertices may take, on device and host: 512M, 2G")
        ->type_name("SIZE")
        ->transform(CLI::AsSizeValue(false))
        ->transform(CLI::Validator(isPositive, "")); // the last one added runs first
    command.add_option("--threads", mThreads, "Most host threads that work at a time")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    command.add_flag("-q,--quiet", mQuiet, "Show no progress");
    command.add_flag("--json", mJson,
                     "Print events on stdout, a JSON object a line: docs/baking.md lists them");
}

void BakeJob::prepare() {
    if (mThreads > 0) mThreadLimit.emplace(mThreads);
    expectExtension("--output", output, ".relume");
    expectWritable(output);
    if (!mTimings.empty()) expectWritable(mTimings);
}

void BakeJob::addOutputs(CommandFiles& files, const std::filesystem::path& replaced) const {
    files.addOutput("--output", output, replaced);
    files.addOutput("--output", checkpointPath(output));
    files.addOutput("--timings", mTimings);
}

BakeSummary BakeJob::bakeStoppably(const vk::Device& opened, const Bake& bake) const {
    BakeReport report(mJson ? ReportStyle::Json : mQuiet ? ReportStyle::Quiet : ReportStyle::Text, true);
    try {
        const BakeSummary summary = bake(report);
        report.close();
        const auto bytes = std::filesystem::file_size(output);
        const uint64_t baked = summary.vertices - summary.resumed;
        report.event("done", {{"output", output.string()},
                              {"bytes", bytes},
                              {"vertices", summary.vertices},
                              {"baked", baked},
                              {"seconds", summary.times.total}});
        spdlog::info("{}: {:.1f} MB, {} vertices in {:.1f} s ({:.2f} ms each) on {}", output.string(),
                     double(bytes) * 1e-6, baked, summary.times.total,
                     1e3 * summary.times.total / double(std::max<uint64_t>(baked, 1)), opened.name());
        if (summary.bytes > 0) tellLayout(summary);
        return summary;
    } catch (const BakeStopped&) {
        report.close();
        report.event("stopped", {{"signal", caughtInterrupt()},
                                 {"done", report.done()},
                                 {"vertices", report.vertices()},
                                 {"checkpoint", checkpointPath(output).string()}});
        spdlog::warn("stopped after {} of {} vertices, kept in {}; the same command goes on from there",
                     report.done(), report.vertices(), checkpointPath(output).string());
        throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    }
}

void BakeJob::tellLayout(const BakeSummary& summary) {
    const double bytes = double(summary.bytes) / double(std::max<uint64_t>(1, summary.vertices));
    const auto error =
        summary.layout ? fmt::format(", error {:.2f} %", 100 * summary.layout->error) : std::string();
    spdlog::info("transport in {}: {:.0f} bytes a vertex in memory{}", layoutName(summary.kept), bytes,
                 error);
    if (summary.layout) warnOfMisses(*summary.layout, bytes, LayoutOrigin::Baked);
}

void BakeJob::run(const vk::Device& opened, const Bake& bake) const {
    const BakeSummary summary = bakeStoppably(opened, bake);
    const BakeTimes& times = summary.times;
    const uint64_t baked = std::max<uint64_t>(summary.vertices - summary.resumed, 1);
    if (!mTimings.empty()) writeFileAtomically(mTimings, describeTimes(times, baked).dump(2) + "\n");
    DeviceArguments::expectNoMessages(opened);
}

void logPart(const std::string& name, const Mesh& mesh, const std::string& materials) {
    spdlog::info("{}: {} vertices, {} triangles, {}", name, mesh.vertexCount(), mesh.triangleCount(),
                 materials);
}

} // namespace relume
