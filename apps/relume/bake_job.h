// A bake to a file as a command runs it: options, progress, stopping and summary.
#pragma once

#include "apps/relume/options.h"
#include "precompute/bake/bake.h"
#include "precompute/thread_limit.h"

#include <functional>

namespace relume {

// --output, --keep-visibility, --device, --timings, --memory, --threads, --quiet, --json
struct BakeJob {
    std::filesystem::path output;
    bool keepVisibility = false;
    BakeLimits limits;
    DeviceArguments device;

    void add(CLI::App& command);

    // Limits threads and checks that outputs can be written, before any work. Throws UsageError and Error.
    void prepare();
    // Adds the files written. `replaced` is an input bake that the output may replace.
    void addOutputs(CommandFiles& files, const std::filesystem::path& replaced = {}) const;

    // Calls `bake`, which bakes to `output`, and prints a summary. Ends the command with an exit code if it
    // was stopped.
    using Bake = std::function<BakeSummary(BakeObserver& observer)>;
    void run(const vk::Device& opened, const Bake& bake) const;

  private:
    static void tellLayout(const BakeSummary& summary);
    BakeSummary bakeStoppably(const vk::Device& opened, const Bake& bake) const;

    std::filesystem::path mTimings;
    int mThreads = 0; // 0: no limit
    bool mQuiet = false, mJson = false;
    std::optional<ThreadLimit> mThreadLimit;
};

// Logs one line about a part to be baked.
void logPart(const std::string& name, const Mesh& mesh, const std::string& materials);

} // namespace relume
