#include "apps/relume/bake_bench.h"

#include "apps/bench/cpu_baker.h"
#include "engine/base/stopwatch.h"
#include "engine/transport/asset_arrays.h"
#include "engine/transport/visibility_chunk.h"
#include "precompute/bake/bake_plan.h"
#include "precompute/bake/part_passes.h"
#include "precompute/thread_limit.h"
#include "precompute/visibility/raster_visibility.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr uint64_t kRun = 64; // neighboring vertices per run

// Returns indices of about `wanted` of `count` vertices, in runs.
std::vector<uint64_t> sampleIndices(uint64_t count, uint64_t wanted) {
    wanted = std::clamp<uint64_t>(wanted, 1, count);
    const uint64_t run = std::min(kRun, wanted), runs = std::min((wanted + run / 2) / run, count / run);
    std::vector<uint64_t> indices;
    for (uint64_t i = 0; i < runs; i++) {
        // Put the run in the middle of the i-th of `runs` equal stretches, none of which is shorter than a
        // run.
        const uint64_t first = (2 * i + 1) * (count - runs * run) / (2 * runs) + i * run;
        for (uint64_t j = 0; j < run; j++) indices.push_back(first + j);
    }
    return indices;
}

// Times a path whose `bakePart(part, points)` bakes one part and returns rows per set.
template <typename BakePart>
SampleRun timeRun(const BakeSample& sample, const BakePart& bakePart) {
    SampleRun run;
    const Stopwatch watch;
    for (size_t part = 0; part < sample.points.size(); part++)
        run.rows.push_back(bakePart(part, std::span(sample.points[part])));
    run.seconds = watch.seconds();
    return run;
}

void addRest(SampleRun& run, const char* name) {
    vk::addTime(run.stages, name, std::max(0.0, run.seconds - vk::secondsOf(run.stages)));
}

} // namespace

uint64_t BakeSample::vertices() const {
    uint64_t count = 0;
    for (const AssetPart& part : asset.parts) count += part.mesh.vertexCount();
    return count;
}

uint64_t BakeSample::sampled() const {
    uint64_t count = 0;
    for (const auto& part : points) count += part.size();
    return count;
}

double BakeSample::termsPerVertex() const {
    double terms = 0;
    for (size_t part = 0; part < points.size(); part++)
        terms += double(points[part].size()) * termCount(asset.parts[part]);
    return terms / double(sampled());
}

BakeSample sampleBake(const vk::Device& device, Scene scene, const BakeOptions& options, uint64_t vertices) {
    BakeObserver silent;
    BakeSample sample{planBake(device, std::move(scene), options, silent).asset, {}};
    const uint64_t all = sample.vertices();
    for (const AssetPart& part : sample.asset.parts) {
        const uint64_t count = part.mesh.vertexCount();
        const double share = double(vertices) * double(count) / double(all);
        std::vector<shared::BakePoint>& points = sample.points.emplace_back();
        for (uint64_t vertex : sampleIndices(count, uint64_t(std::llround(share))))
            points.push_back(bakePoint(part.mesh, vertex, sample.asset.visibilityOffset));
    }
    return sample;
}

double relativeDifference(const SampleRows& a, const SampleRows& b, int faceSize) {
    const vec3 maxima(kRedMaximum, kGreenMaximum, kBlueMaximum);
    std::vector<vec3> dense(6 * size_t(faceSize) * size_t(faceSize), vec3(0));
    const auto addRow = [&](const SparseTransport& rows, size_t row, float sign) {
        for (uint64_t e = rows.rowStarts[row]; e < rows.rowStarts[row + 1]; e++)
            dense[rows.indices[e]] +=
                sign * vec3(unpackCoefficient(rows.values[e])) * (rows.scales[row] / maxima);
    };
    // Returns the energy that a row has left in `dense`, and clears it.
    const auto takeEnergy = [&](const SparseTransport& rows, size_t row) {
        double energy = 0;
        for (uint64_t e = rows.rowStarts[row]; e < rows.rowStarts[row + 1]; e++) {
            vec3& value = dense[rows.indices[e]];
            energy += double(glm::dot(value, value));
            value = vec3(0);
        }
        return energy;
    };
    double difference = 0, size = 0;
    for (size_t part = 0; part < b.size(); part++)
        for (size_t set = 0; set < b[part].size(); set++) {
            const SparseTransport &left = a[part][set], &right = b[part][set];
            RELUME_CHECK_EQ(left.rows(), right.rows());
            for (size_t row = 0; row < right.rows(); row++) {
                addRow(right, row, 1);
                size += takeEnergy(right, row);
                addRow(left, row, 1);
                addRow(right, row, -1);
                difference += takeEnergy(left, row) + takeEnergy(right, row);
            }
        }
    return size > 0 ? std::sqrt(difference / size) : 0;
}

struct CpuPath::Part {
    CpuBaker baker;
};

CpuPath::CpuPath(const BakeSample& sample, const BakeOptions& options) : mSample(sample) {
    for (const AssetPart& part : sample.asset.parts)
        mParts.push_back({CpuBaker(sample.asset, part, options)});
}

CpuPath::~CpuPath() = default;

SampleRun CpuPath::run() {
    CpuBakeTimes before, after;
    for (const Part& part : mParts) before += part.baker.times();
    TransportLosses losses;
    SampleRun run = timeRun(mSample, [&](size_t part, auto points) {
        std::vector<SparseTransport> rows;
        std::vector<SparseTransport*> transports;
        for (const MaterialSet& set : mSample.asset.parts[part].sets)
            rows.push_back({uint32_t(points.size()), uint32_t(set.brdf.terms), {0}, {}, {}, {}});
        for (SparseTransport& transport : rows) transports.push_back(&transport);
        mParts[part].baker.bake(points, transports, losses);
        return rows;
    });
    for (const Part& part : mParts) after += part.baker.times();
    mRays = after.rays - before.rays;
    const auto addStage = [&](const char* name, double CpuBakeTimes::*stage) {
        vk::addTime(run.stages, name, (after.*stage - before.*stage) / double(allowedThreads()));
    };
    addStage("visibility", &CpuBakeTimes::visibility);
    addStage("transport", &CpuBakeTimes::transport);
    addStage("haar", &CpuBakeTimes::haar);
    addStage("select and pack", &CpuBakeTimes::pack);
    addRest(run, "output and idle threads");
    return run;
}

struct DevicePath::Part {
    std::unique_ptr<PartPasses> passes;
};

DevicePath::DevicePath(const vk::Device& device, const BakeSample& sample, const BakeOptions& options,
                       VisibilityMethod method)
    : mSample(sample) {
    BakeOptions own = options;
    own.visibilityMethod = method;
    for (const AssetPart& part : sample.asset.parts)
        mParts.push_back({std::make_unique<PartPasses>(device, sample.asset, part, own, BakeLimits{})});
}

DevicePath::~DevicePath() = default;

// Adds the seconds of all parts' passes so far, times `sign`.
template <typename Parts>
void addStages(const Parts& parts, double sign, vk::PassTimes& stages) {
    for (const auto& part : parts)
        for (const auto& [name, seconds] : part.passes->times()) vk::addTime(stages, name, sign * seconds);
}

static std::vector<SparseTransport> transportsOf(std::vector<BakedRows> baked) {
    std::vector<SparseTransport> rows;
    for (BakedRows& set : baked) rows.push_back(std::move(set.transport));
    return rows;
}

SampleRun DevicePath::run() {
    vk::PassTimes before;
    addStages(mParts, -1, before);
    SampleRun run = timeRun(mSample, [&](size_t part, auto points) {
        std::vector<BakedRows> baked = emptyBakedRows(mSample.asset.parts[part]);
        mParts[part].passes->bake(points, baked);
        return transportsOf(std::move(baked));
    });
    run.stages = before;
    addStages(mParts, 1, run.stages);
    addRest(run, "host and submission");
    return run;
}

struct RebakePath::Part {
    std::unique_ptr<PartPasses> passes;
    std::vector<StoredChunk> blocks; // of kRun points each
};

RebakePath::RebakePath(const vk::Device& device, const BakeSample& sample, const BakeOptions& options)
    : mSample(sample), mOptions(options) {
    mOptions.visibilityMethod = usableMethod(device, VisibilityMethod::Traced);
    mOptions.keepVisibility = true;
    const auto size = uint32_t(options.visibilitySize);
    for (size_t number = 0; number < sample.points.size(); number++) {
        const AssetPart& part = sample.asset.parts[number];
        Part& made = mParts.emplace_back();
        PartPasses finder(device, sample.asset, part, mOptions);
        for (std::span<const shared::BakePoint> rest = sample.points[number]; !rest.empty();) {
            const auto block = rest.first(std::min<size_t>(kRun, rest.size()));
            std::vector<BakedRows> rows = emptyBakedRows(part);
            std::vector<uint32_t> bits;
            finder.bake(block, rows, {}, &bits);
            made.blocks.push_back(storeChunk(kVisibility, uint32_t(number), uint32_t(made.blocks.size()),
                                             encodeVisibility(bits, size)));
            rest = rest.subspan(block.size());
        }
        made.passes = std::make_unique<PartPasses>(device, sample.asset, part, mOptions, BakeLimits{},
                                                   VisibilitySource::Given);
    }
}

RebakePath::~RebakePath() = default;

SampleRun RebakePath::run() {
    vk::PassTimes before;
    addStages(mParts, -1, before);
    double decoding = 0;
    SampleRun run = timeRun(mSample, [&](size_t part, auto points) {
        std::vector<BakedRows> baked = emptyBakedRows(mSample.asset.parts[part]);
        for (const StoredChunk& stored : mParts[part].blocks) {
            const auto block = points.first(std::min<size_t>(kRun, points.size()));
            const Stopwatch watch;
            const std::vector<uint32_t> bits =
                decodeVisibility(unpackChunk(stored.entry, stored.bytes, "sample"), block.size(),
                                 uint32_t(mOptions.visibilitySize), "sample");
            decoding += watch.seconds();
            mParts[part].passes->bake(block, baked, bits);
            points = points.subspan(block.size());
        }
        return transportsOf(std::move(baked));
    });
    run.stages = before;
    addStages(mParts, 1, run.stages);
    vk::addTime(run.stages, "visibility decode", decoding);
    addRest(run, "host and submission");
    return run;
}

uint64_t countDrawnTriangles(const vk::Device& device, const BakeSample& sample, const BakeOptions& options) {
    constexpr uint32_t kBatch = 16;
    const auto size = uint32_t(options.visibilitySize);
    const RasterVisibility visibility(device, sample.asset.occluder, size, kBatch,
                                      visibilityNearDistance(sample.asset.visibilityOffset));
    const vk::Buffer points(device, kBatch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points");
    const vk::Buffer bits(device, kBatch * visibilityBytes(size), vk::BufferUse::Device, "visibility bits");
    vk::Commands commands(device, "count triangles");
    uint64_t triangles = 0;
    for (std::span<const shared::BakePoint> part : sample.points)
        for (; !part.empty(); part = part.subspan(std::min<size_t>(part.size(), kBatch))) {
            const auto count = std::min<size_t>(part.size(), kBatch);
            std::ranges::copy(part.first(count), points.map<shared::BakePoint>().begin());
            commands.begin();
            visibility.record(commands, points, uint32_t(count), bits);
            commands.submitAndWait();
            triangles += visibility.drawnTriangles(device, uint32_t(count));
        }
    return triangles;
}

BakeTraffic::BakeTraffic(const BakeSample& sample, const BakeOptions& options, double raysPerVertex,
                         double trianglesPerVertex)
    : mRays(raysPerVertex), mTriangles(trianglesPerVertex),
      mTexels(6.0 * options.visibilitySize * options.visibilitySize),
      mCoefficients(sample.termsPerVertex() * 6 * options.faceSize * options.faceSize),
      mKept(sample.termsPerVertex() * options.coefficients) {}

std::optional<double> BakeTraffic::cpu(const std::string& stage) const {
    constexpr double kDirection = 12, kCoefficient = 12, kEntry = 6;
    if (stage == "visibility") return mRays * kDirection + mTexels / 8;
    if (stage == "transport") return mTexels / 8 + mCoefficients * kCoefficient;
    if (stage == "haar") return 2 * mCoefficients * kCoefficient;
    if (stage == "select and pack") return mKept * (kCoefficient + kEntry);
    return std::nullopt;
}

std::optional<double> BakeTraffic::device(const std::string& stage) const {
    constexpr double kTriangleIndices = 12, kCoefficient = 12, kIndex = 4, kValue = 4;
    const double blocks = mCoefficients / 15, summaries = blocks * 8, slots = blocks * 16 * kCoefficient;
    if (stage == "visibility draw") return mTexels + mTriangles * kTriangleIndices; // one byte per texel
    if (stage == "visibility pack") return 3 * mTexels + mTexels / 8;               // copied, then packed
    if (stage == "visibility trace") return mTexels / 8;
    if (stage == "transport")
        return mTexels / 8 + slots + blocks * kCoefficient + summaries; // averages twice
    if (stage == "select") return summaries + mKept * (kCoefficient + kIndex);
    if (stage == "quantize") return mKept * (kIndex + kCoefficient + kValue);
    if (stage == "compact") return mKept * 2 * (kIndex + kValue);
    return std::nullopt;
}

} // namespace relume
