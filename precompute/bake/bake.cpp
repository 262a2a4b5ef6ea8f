#include "precompute/bake/bake.h"

#include "engine/base/check.h"
#include "engine/base/file.h"
#include "engine/base/log.h"
#include "engine/base/stopwatch.h"
#include "precompute/bake/bounced_transport.h"
#include "precompute/bake/checkpoint.h"
#include "precompute/bake/layout_sample.h"
#include "precompute/bake/preview.h"
#include "precompute/bake/shard_file.h"
#include "precompute/bake/stored_blocks.h"
#include "precompute/bake/storing_sink.h"

#include <fmt/core.h>

namespace relume {

namespace {

BakeTimes timesOf(const BakePlan& plan) {
    BakeTimes times;
    times.factorization = plan.factorizationSeconds;
    times.occluder = plan.occluderSeconds;
    return times;
}

// Opens the visibility in a file; returns null if it has none or is not an asset.
std::unique_ptr<KeptVisibility> findKept(const std::filesystem::path& path) {
    try {
        auto kept = std::make_unique<KeptVisibility>(path);
        if (!kept->key().empty()) return kept;
    } catch (const Error&) {
    }
    return nullptr;
}

// Drops `kept` unless its key is the plan's and it is intact.
void dropUnfit(std::unique_ptr<KeptVisibility>& kept, const BakePlan& plan) {
    if (!kept) return;
    try {
        if (kept->key() != plan.visibilityKey)
            kept.reset();
        else
            kept->verify(plan.asset);
    } catch (const Error& damage) {
        log(LogLevel::Warning, fmt::format("{}; visibility is found anew", damage.what()));
        kept.reset();
    }
}

// Bakes all blocks of a plan, or those of a shard, and writes the file.
BakeSummary bakePlanned(const vk::Device& device, BakePlan& plan, KeptVisibility* kept,
                        const OutputOptions& outputOptions, Checkpoint& checkpoint,
                        const std::filesystem::path& output, const BakeLimits& limits,
                        BakeObserver& observer) {
    const std::optional<Shard>& shard = outputOptions.shard;
    std::optional<Checkpoint> interpolated; // removed at the end, even if an earlier run made it
    if (outputOptions.previews || std::filesystem::exists(interpolatedPath(output)))
        interpolated.emplace(interpolatedPath(output));
    checkpoint.resume(plan);
    plan.scale = checkpoint.scale();
    BakeSummary summary;
    summary.times = timesOf(plan);
    const auto isOwn = [&](uint32_t block) { return !shard || shard->has(block); };
    std::vector<uint32_t> own, missing;
    for (uint32_t block = 0; block < plan.blocks.size(); block++) {
        if (!isOwn(block)) continue;
        own.push_back(block);
        summary.vertices += plan.blocks[block].count();
        if (checkpoint.has(block))
            summary.resumed += plan.blocks[block].count();
        else
            missing.push_back(block);
    }
    observer.resumed(summary.resumed, summary.vertices);
    if (kept && !missing.empty())
        log(LogLevel::Info, fmt::format("{}: visibility of {} vertices reused", kept->file().name(),
                                        summary.vertices - summary.resumed));
    const auto poll = [&] {
        if (observer.wantsStop()) throw BakeStopped("stopped");
    };
    const auto writeFile = [&](const std::function<void(const ChunkWriter::Output&)>& writeTo) {
        // The temporary name needs no random part, since the checkpoint's lock excludes other bakes.
        AtomicFile file(output, ".partial");
        writeTo([&](std::span<const std::byte> bytes) {
            poll();
            file.write(bytes);
        });
        file.commit();
    };
    const auto writeWhole = [&](const StoredBlocks& blocks) {
        writeFile(
            [&](const ChunkWriter::Output& write) { summary.bytes = writeBake(plan, blocks, write, poll); });
    };
    StoringSink sink(plan, StoringSink::bytesInHand(limits),
                     [&](uint32_t block, StoredBlock stored) { checkpoint.append(block, stored); });
    std::optional<Previews> previews;
    if (outputOptions.previews && !missing.empty()) {
        previews.emplace(device, plan, missing, limits, checkpoint, *interpolated, writeWhole, observer);
        if (plan.options.bounces > 0 || (plan.needsScale() && !plan.scale)) previews->writeDraft();
    }
    // Bounces are computed even if no block is missing: the file also needs the shares of direct light.
    if (plan.options.bounces > 0)
        plan.bounced = bounceTransport(device, plan, limits, observer, summary.times);
    if (plan.needsScale() && !plan.scale && !missing.empty()) {
        std::vector<SampledBlock> sample = bakeSample(device, plan, limits, observer, summary.times, kept);
        checkpoint.append(*plan.scale);
        for (SampledBlock& sampled : sample)
            if (isOwn(sampled.block)) sink.take(sampled.block, std::move(sampled.baked));
        sink.finish();
        std::erase_if(missing, [&](uint32_t block) { return checkpoint.has(block); });
        if (missing.empty()) {
            observer.stage(BakeStage::Baking, "");
            observer.progress({.vertices = summary.vertices, .done = summary.vertices, .fraction = 1});
        }
    }
    if (previews && !missing.empty())
        previews->bake(missing, limits, sink, kept, summary.times);
    else
        bakeBlocks(device, plan, missing, own, limits, sink, observer, summary.times, kept);
    observer.stage(BakeStage::Writing, "");
    if (shard)
        writeFile([&](const ChunkWriter::Output& write) { writeShard(plan, *shard, checkpoint, write); });
    else
        writeWhole(checkpoint);
    summary.kept = plan.options.layout.layout;
    summary.layout = plan.asset.layout;
    checkpoint.remove();
    if (interpolated) interpolated->remove();
    return summary;
}

} // namespace

Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options) {
    BakeObserver silent;
    return bake(device, std::move(scene), options, silent);
}

Asset bake(const vk::Device& device, Scene scene, const BakeOptions& options, BakeObserver& observer,
           BakeTimes* timesOut) {
    const Stopwatch watch;
    BakeOptions inMemory = options;
    inMemory.keepVisibility = false;
    BakePlan plan = planBake(device, std::move(scene), inMemory, observer);
    BakeTimes times = timesOf(plan);
    const std::vector<uint32_t> all = plan.allBlocks();
    std::vector<uint32_t> missing = all;
    MemoryBlocks blocks;
    StoringSink sink(plan, StoringSink::bytesInHand({}),
                     [&](uint32_t block, StoredBlock stored) { blocks.keep(block, std::move(stored)); });
    if (plan.options.bounces > 0) plan.bounced = bounceTransport(device, plan, {}, observer, times);
    if (plan.needsScale())
        for (SampledBlock& sampled : bakeSample(device, plan, {}, observer, times, nullptr)) {
            std::erase(missing, sampled.block);
            sink.take(sampled.block, std::move(sampled.baked));
        }
    sink.finish();
    if (missing.empty()) {
        observer.stage(BakeStage::Baking, "");
        observer.progress({.vertices = plan.vertices(), .done = plan.vertices(), .fraction = 1});
    }
    bakeBlocks(device, plan, missing, all, {}, sink, observer, times);
    std::vector<std::byte> file;
    writeBake(plan, blocks,
              [&](std::span<const std::byte> bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); });
    Asset asset = decodeAsset(file, "the bake");
    times.total = watch.seconds();
    if (timesOut) *timesOut = times;
    return asset;
}

std::filesystem::path checkpointPath(const std::filesystem::path& output) {
    // A symbolic link is resolved, since two bakes must not write the same file.
    std::error_code failure;
    const bool isLink = std::filesystem::is_symlink(output, failure);
    return (isLink ? std::filesystem::weakly_canonical(output) : output).string() + ".checkpoint";
}

std::filesystem::path interpolatedPath(const std::filesystem::path& output) {
    return checkpointPath(output).string() + ".preview";
}

BakeSummary bakeToFile(const vk::Device& device, Scene scene, const BakeOptions& options,
                       const std::filesystem::path& output, const BakeLimits& limits, BakeObserver& observer,
                       const OutputOptions& outputOptions) {
    RELUME_CHECK(!outputOptions.previews || (!outputOptions.shard && !options.keepVisibility));
    const Stopwatch watch;
    Checkpoint checkpoint(checkpointPath(output));
    BakePlan plan = planBake(device, std::move(scene), options, observer);
    std::unique_ptr<KeptVisibility> kept =
        findKept(outputOptions.visibility.empty() ? output : outputOptions.visibility);
    dropUnfit(kept, plan);
    BakeSummary summary =
        bakePlanned(device, plan, kept.get(), outputOptions, checkpoint, output, limits, observer);
    summary.times.total = watch.seconds();
    return summary;
}

BakeSummary rebakeToFile(const vk::Device& device, KeptVisibility& kept, Asset skeleton,
                         const std::vector<std::string>& materials, const BakeOptions& options,
                         const std::filesystem::path& output, const BakeLimits& limits,
                         BakeObserver& observer) {
    const Stopwatch watch;
    Checkpoint checkpoint(checkpointPath(output));
    const std::string bakedOn = skeleton.provenance.device;
    BakePlan plan = planRebake(device, std::move(skeleton), materials, options, observer);
    if (kept.key() != plan.visibilityKey)
        throw Error(fmt::format(
            "{}: its visibility was found by another program, driver or device ({}; this is {}) or for "
            "another mesh; `relume bake --keep-visibility` it again here",
            kept.file().name(), bakedOn, plan.asset.provenance.device));
    kept.verify(plan.asset);
    BakeSummary summary = bakePlanned(device, plan, &kept, {}, checkpoint, output, limits, observer);
    summary.times.total = watch.seconds();
    return summary;
}

} // namespace relume
