#include "apps/relume/command_files.h"
#include "apps/relume/commands.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/interrupt.h"
#include "engine/base/progress.h"
#include "engine/transport/asset_arrays.h"
#include "precompute/bake/merge.h"
#include "precompute/bake_observer.h"

#include <algorithm>
#include <fmt/core.h>
#include <optional>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

namespace relume {

namespace {

struct MergeArguments {
    std::vector<std::filesystem::path> parts;
    std::filesystem::path output;
    bool quiet = false;
};

void checkOutput(const MergeArguments& arguments) {
    expectExtension("--output", arguments.output, ".relume");
    CommandFiles files;
    for (const std::filesystem::path& part : arguments.parts) files.addInput(part);
    files.addOutput("--output", arguments.output);
    files.check();
    expectWritable(arguments.output);
}

// Raises the limit of open files, since all parts are open at once.
void allowOpenFiles() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    (void)setrlimit(RLIMIT_NOFILE, &limit);
}

uint64_t totalBytes(const std::vector<std::filesystem::path>& parts) {
    uint64_t bytes = 0;
    std::error_code failure;
    for (const std::filesystem::path& part : parts) {
        const auto size = std::filesystem::file_size(part, failure);
        if (!failure) bytes += size;
    }
    return bytes;
}

// Returns the stored bytes of transport in bases.
uint64_t basesBytes(const std::vector<ShardFile>& shards) {
    uint64_t bytes = 0;
    for (const ShardFile& shard : shards)
        for (const ChunkEntry& entry : shard.chunks().entries())
            if (entry.tag == BasisTransport::kTag) bytes += entry.storedSize;
    return bytes;
}

uint64_t merge(const MergeArguments& arguments) {
    // Every byte is read twice: checked before anything is written, then copied. Bases' columns are counted
    // in between.
    constexpr uint64_t kMegabyte = 1000000;
    const uint64_t allBytes = totalBytes(arguments.parts);
    uint64_t read = 0, total = 0;
    std::optional<Progress> progress;
    const auto begin = [&](const char* title, uint64_t bytes) {
        read = 0, total = bytes / kMegabyte;
        progress.emplace(title, total, "MB", arguments.quiet);
    };
    const auto watch = [&](uint64_t bytes) {
        if (caughtInterrupt() != 0) throw BakeStopped("stopped");
        read += bytes;
        progress->update(std::min(read / kMegabyte, total));
    };
    begin("checking parts", allBytes);
    std::vector<ShardFile> shards;
    for (const std::filesystem::path& part : arguments.parts) shards.emplace_back(part, watch);

    begin("writing", allBytes + basesBytes(shards));
    AtomicFile file(arguments.output);
    const uint64_t vertices =
        mergeShards(shards, [&](std::span<const std::byte> bytes) { file.write(bytes); });
    file.commit();
    progress->update(total);
    return vertices;
}

void run(const MergeArguments& arguments) {
    checkOutput(arguments);
    allowOpenFiles();
    catchInterrupts();
    try {
        const uint64_t vertices = merge(arguments);
        spdlog::info("{}: {:.1f} MB, {} vertices from {} parts", arguments.output.string(),
                     double(std::filesystem::file_size(arguments.output)) * 1e-6, vertices,
                     arguments.parts.size());
    } catch (const BakeStopped&) {
        spdlog::warn("stopped; {} is as it was", arguments.output.string());
        throw CLI::RuntimeError(kExitStopped + caughtInterrupt());
    }
}

} // namespace

void addMergeCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("merge", "Join the parts that `relume bake --shard` made into one bake");
    const auto arguments = std::make_shared<MergeArguments>();
    command->add_option("PART", arguments->parts, "All parts of a bake, in any order (.relume)")->required();
    command->add_option("-o,--output", arguments->output, "Bake to write (.relume)")
        ->type_name("FILE")
        ->required();
    command->add_flag("-q,--quiet", arguments->quiet, "Show no progress");
    command->footer(
        "relume bake MESH --shard 0/2 -o part-0.relume && relume bake MESH --shard 1/2 -o part-1.relume\n"
        "relume merge part-*.relume -o whole.relume\n"
        "The result is byte for byte that of `relume bake MESH -o whole.relume`: "
        "docs/many_machines.md");
    command->callback([arguments] { run(*arguments); });
}

} // namespace relume
