// A bake to a file as a command runs it: options, progress, stopping, what is said at the end.
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

    // Before any work: bounds threads, and tries what is to be written. Throws UsageError, Error.
    void prepare();
    // Adds what is written. `replaced`: a bake that is read, and that the output may replace.
    void addOutputs(CommandFiles& files, const std::filesystem::path& replaced = {}) const;

    // Calls `bake`, which bakes to `output`, and tells what was made; ends the command where it was stopped.
    using Bake = std::function<BakeSummary(BakeObserver& observer)>;
    void run(const vk::Device& opened, const Bake& bake) const;

  private:
    static void tellLayout(const BakeSummary& summary);
    BakeSummary bakeStoppably(const vk::Device& opened, const Bake& bake) const;

    std::filesystem::path mTimings;
    int mThreads = 0; // as many as there are
    bool mQuiet = false, mJson = false;
    std::optional<ThreadLimit> mThreadLimit;
};

// One line a part: what is about to be baked.
void logPart(const std::string& name, const Mesh& mesh, const std::string& materials);

} // namespace relume
