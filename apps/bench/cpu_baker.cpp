#include "apps/bench/cpu_baker.h"

#include "engine/base/check.h"
#include "engine/base/stopwatch.h"
#include "precompute/thread_limit.h"

#include <algorithm>
#include <memory>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>

namespace relume {

namespace {

constexpr size_t kTaskPoints = 4; // neighbors, which share cached parts of the occluder

// Buffers of one thread.
struct Workspace {
    Workspace(const CpuVisibility& visibility, const CpuTransport& transport, int kept)
        : bits(visibility.texels() / 64), coefficients(transport.makeWorkspace()), packer(transport, kept) {}

    std::vector<uint64_t> bits;
    CpuCoefficients coefficients;
    CpuRowPacker packer;
};

struct TaskResult {
    std::vector<CpuRows> points;
    CpuBakeTimes times;
};

std::vector<const FactoredBrdf*> brdfsOf(const AssetPart& part) {
    std::vector<const FactoredBrdf*> brdfs;
    for (const MaterialSet& set : part.sets) brdfs.push_back(&set.brdf);
    return brdfs;
}

// Appends one point's rows to the transport of each set.
void append(const CpuRows& rows, std::span<const int> setTerms,
            std::span<SparseTransport* const> transports) {
    size_t term = 0, entry = 0;
    for (size_t set = 0; set < setTerms.size(); set++) {
        SparseTransport& transport = *transports[set];
        for (int k = 0; k < setTerms[set]; k++, term++) {
            const size_t end = entry + rows.counts[term];
            transport.indices.insert(transport.indices.end(), rows.indices.begin() + std::ptrdiff_t(entry),
                                     rows.indices.begin() + std::ptrdiff_t(end));
            transport.values.insert(transport.values.end(), rows.values.begin() + std::ptrdiff_t(entry),
                                    rows.values.begin() + std::ptrdiff_t(end));
            transport.rowStarts.push_back(transport.values.size());
            transport.scales.push_back(rows.scales[term]);
            entry = end;
        }
    }
}

} // namespace

CpuBakeTimes& CpuBakeTimes::operator+=(const CpuBakeTimes& other) {
    visibility += other.visibility;
    transport += other.transport;
    haar += other.haar;
    pack += other.pack;
    rays += other.rays;
    return *this;
}

CpuBaker::CpuBaker(const Asset& asset, const AssetPart& part, const BakeOptions& options)
    : mVisibility(asset.occluder, options.visibilitySize),
      mTransport(brdfsOf(part), options.faceSize, options.visibilitySize, options.transportSamples),
      mKept(options.coefficients) {
    for (const MaterialSet& set : part.sets) mSetTerms.push_back(set.brdf.terms);
}

void CpuBaker::bake(std::span<const shared::BakePoint> points, std::span<SparseTransport* const> transports,
                    TransportLosses& losses) {
    RELUME_CHECK_EQ(transports.size(), mSetTerms.size());
    tbb::enumerable_thread_specific<Workspace> workspaces(
        [this] { return Workspace(mVisibility, mTransport, mKept); });

    size_t next = 0;
    const auto takeTask = [&](tbb::flow_control& control) {
        const size_t first = next, count = std::min(kTaskPoints, points.size() - first);
        if (count == 0) control.stop();
        next += count;
        return points.subspan(first, count);
    };
    const auto bakeTask = [&](std::span<const shared::BakePoint> task) {
        Workspace& own = workspaces.local();
        auto result = std::make_shared<TaskResult>();
        result->points.resize(task.size());
        Stopwatch clock;
        for (size_t i = 0; i < task.size(); i++) {
            CpuBakeTimes& times = result->times;
            times.rays += mVisibility.trace(task[i].origin, task[i].normal, own.bits);
            times.visibility += clock.restart();
            mTransport.evaluate(tangentFrame(task[i].normal, task[i].tangent), own.bits, own.coefficients);
            times.transport += clock.restart();
            mTransport.transform(own.coefficients);
            times.haar += clock.restart();
            own.packer.pack(own.coefficients, result->points[i]);
            times.pack += clock.restart();
        }
        return result;
    };
    const auto appendTask = [&](const std::shared_ptr<TaskResult>& result) {
        mTimes += result->times;
        for (const CpuRows& rows : result->points) {
            append(rows, mSetTerms, transports);
            losses.total += rows.losses.total;
            losses.dropped += rows.losses.dropped;
            losses.quantized += rows.losses.quantized;
        }
    };
    using Task = std::span<const shared::BakePoint>;
    using Result = std::shared_ptr<TaskResult>;
    const auto tokens = 4 * allowedThreads();
    tbb::parallel_pipeline(tokens,
                           tbb::make_filter<void, Task>(tbb::filter_mode::serial_in_order, takeTask) &
                               tbb::make_filter<Task, Result>(tbb::filter_mode::parallel, bakeTask) &
                               tbb::make_filter<Result, void>(tbb::filter_mode::serial_in_order, appendTask));
}

} // namespace relume
