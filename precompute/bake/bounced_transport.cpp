#include "precompute/bake/bounced_transport.h"

#include "engine/base/error.h"
#include "engine/base/log.h"
#include "engine/base/stopwatch.h"
#include "engine/math/color.h"
#include "precompute/bake/baked_options.h"
#include "precompute/bake/vertex_rows.h"
#include "precompute/bounce/bounce_gather_pass.h"
#include "precompute/transport/row_sum.h"
#include "precompute/visibility/visibility.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <map>
#include <numeric>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

namespace relume {

namespace {

// Sources, the transport that lights others, have the smallest sizes that the kernels support.
constexpr int kSourceFaceSize = 32, kSourceVisibilitySize = 64;

// Returns a low-resolution plan, without an occluder yet.
BakePlan planOfSources(const BakePlan& plan) {
    BakePlan sources{plan.options};
    sources.options.keepVisibility = false;
    sources.options.transportSamples = 1;
    sources.asset.faceSize = sources.options.faceSize = kSourceFaceSize;
    sources.asset.visibilitySize = sources.options.visibilitySize = kSourceVisibilitySize;
    // Rows have bounceEntries(), as rowEntries() has them for bases, whatever the bake's layout is.
    constexpr int kSourceCoefficients = bounceEntries(2);
    static_assert(bounceEntries(1) == kOneTermEntries * kSourceCoefficients);
    sources.asset.coefficients = sources.options.coefficients = kSourceCoefficients;
    sources.asset.visibilityOffset = plan.asset.visibilityOffset;
    sources.blockVertices = plan.blockVertices;
    for (size_t number = 0; number < plan.asset.parts.size(); number++) {
        const AssetPart& part = plan.asset.parts[number];
        AssetPart& source = sources.asset.parts.emplace_back();
        source.name = part.name;
        source.mesh = part.mesh;
        source.sets = part.sets;
        for (MaterialSet& set : source.sets) set.transport = BasisTransport();
    }
    sources.firstSet = plan.firstSet;
    return sources;
}

// Responses of rows to even light, in luminance, up to a factor: per part, set and row.
using EvenResponses = std::vector<std::vector<std::vector<float>>>;

// Returns a row's response, of coefficients of kBounceFaceSize.
float evenResponse(const SparseTransport& rows, size_t row) {
    constexpr int kFaceCoefficients = kBounceFaceSize * kBounceFaceSize; // the first is the face's mean
    vec3 sum(0);
    for (uint64_t entry = rows.rowStarts[row]; entry < rows.rowStarts[row + 1]; entry++)
        if (rows.indices[entry] % kFaceCoefficients == 0) sum += vec3(unpackCoefficient(rows.values[entry]));
    return luminance(sum * kCoefficientUnit) * rows.scales[row];
}

// Stores the shares of direct light in sets that form ratios (MaterialSet::directShares).
void storeShares(Asset& asset, const EvenResponses& direct,
                 const std::vector<std::vector<SparseTransport>>& bounced) {
    for (size_t part = 0; part < asset.parts.size(); part++)
        for (size_t number = 0; number < asset.parts[part].sets.size(); number++) {
            MaterialSet& set = asset.parts[part].sets[number];
            if (!set.residual || !set.residual->hasNonnegativeTerms) continue;
            const SparseTransport& rows = bounced[part][number];
            set.directShares.assign(rows.vertices * set.shareWords(), 0);
            for (size_t row = 0; row < rows.rows(); row++) {
                const size_t vertex = row / rows.terms, term = row % rows.terms;
                const float own = std::max(direct[part][number][row], 0.0f),
                            others = std::max(evenResponse(rows, row), 0.0f);
                const float share = own + others > 0 ? own / (own + others) : 1;
                set.directShares[vertex * set.shareWords() + term / 4] |= uint32_t(std::lround(255 * share))
                                                                          << (8 * (term % 4));
            }
        }
}

// Returns, per part, the direct transport of its bound set, and adds the responses of all sets.
std::vector<SparseTransport> bakeSources(const vk::Device& device, BakePlan& plan, const Appearance& bound,
                                         const BakeLimits& limits, BakeObserver& observer, BakeTimes& times,
                                         EvenResponses& responses) {
    std::vector<std::vector<uint32_t>> vertices;
    std::vector<SparseTransport> rows;
    for (size_t number = 0; number < plan.asset.parts.size(); number++) {
        const AssetPart& part = plan.asset.parts[number];
        std::vector<uint32_t>& all = vertices.emplace_back(part.mesh.vertexCount());
        std::iota(all.begin(), all.end(), 0u);
        rows.push_back(emptyRows(uint32_t(part.sets[bound[number].set].brdf.terms)));
        responses.emplace_back(part.sets.size());
    }
    BakePlan sources = planOfSources(plan);
    std::swap(sources.asset.occluder, plan.asset.occluder); // large: never two copies
    const TakeRows take = [&](uint32_t part, std::span<const BakedRows> sets) {
        for (size_t set = 0; set < sets.size(); set++) {
            const SparseTransport coarse = bounceRows(sets[set].transport, kSourceFaceSize);
            for (size_t row = 0; row < coarse.rows(); row++)
                responses[part][set].push_back(evenResponse(coarse, row));
            if (set == bound[part].set) appendRows(rows[part], coarse);
        }
    };
    bakeVertices(device, sources, vertices, limits, take, observer, times);
    std::swap(sources.asset.occluder, plan.asset.occluder);
    return rows;
}

// Throws Error if the host cannot hold the rows needed for bounces.
void expectMemory(const BakePlan& plan, const Appearance& bound) {
    const uint64_t needed = bounceBytes(plan.asset, bound);
    const uint64_t present = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
    if (needed > present)
        throw Error(fmt::format("--bounces: finding bounced light of {} vertices takes up to {:.1f} GB of "
                                "memory, this machine has {:.1f}: use --bounces 0, fewer --terms, or "
                                "simplify the mesh",
                                plan.vertices(), double(needed) * 1e-9, double(present) * 1e-9));
}

// Logs parts whose factors reflect more light than they receive.
void logHeld(const BakePlan& plan, const BounceHits& hits) {
    std::map<size_t, float> shares; // by part, the largest over its layers
    for (const BounceHits::HeldLayer& held : hits.heldLayers())
        shares[held.part] = std::max(shares[held.part], held.share);
    for (const auto& [part, share] : shares)
        log(LogLevel::Info,
            fmt::format(
                "{}: factors reflect {:.2f} of even light; as a source of bounced light they are held to 1",
                plan.asset.parts[part].name, share));
}

// Returns rows made in parallel: make(row, sum), called once for each row and concurrently, uses a RowSum of
// `coefficients`, which is empty and must be left so.
template <typename Make>
SparseTransport rowsInParallel(uint32_t vertices, uint32_t terms, size_t coefficients, const Make& make) {
    // Vertices of a task, and of a round, after which portions are joined: few of them exist twice.
    constexpr uint32_t kTogether = 8, kRound = 4096;
    tbb::enumerable_thread_specific<RowSum> sums(coefficients);
    SparseTransport rows = emptyRows(terms);
    for (uint32_t begin = 0; begin < vertices; begin += kRound) {
        const uint32_t end = std::min(begin + kRound, vertices);
        std::vector<SparseTransport> portions((end - begin + kTogether - 1) / kTogether, emptyRows(terms));
        const auto makePortion = [&](size_t number) {
            const auto first = uint32_t(begin + number * kTogether), last = std::min(first + kTogether, end);
            for (size_t row = size_t(first) * terms; row < size_t(last) * terms; row++)
                appendRow(portions[number], make(row, sums.local()));
            portions[number].vertices = last - first;
        };
        // Isolated: a thread that waits for the last portion must not begin other work, such as storing a
        // block.
        tbb::this_task_arena::isolate([&] { tbb::parallel_for(size_t(0), portions.size(), makePortion); });
        for (const SparseTransport& portion : portions) appendRows(rows, portion);
    }
    return rows;
}

// Adds transport row by row.
SparseTransport sumOf(const SparseTransport& a, const SparseTransport& b) {
    const int kept = bounceEntries(int(a.terms));
    return rowsInParallel(a.vertices, a.terms, kBounceCoefficients, [&](size_t row, RowSum& sum) {
        sum.add(a, row, 1);
        sum.add(b, row, 1);
        return sum.pack(kept);
    });
}

// Returns whether the device gathers light, which on the host's own cores takes longer than the host does.
// Sources may be too large for it.
bool gathersOnDevice(const vk::Device& device, std::span<const SparseTransport> sources) {
    if (device.info().isSoftware) return false;
    uint64_t entries = 0;
    for (const SparseTransport& part : sources)
        entries += part.rows() * uint64_t(bounceEntries(int(part.terms)));
    if (BounceGatherPass::canGatherFrom(device, entries)) return true;
    log(LogLevel::Warning, fmt::format("bounced light: {:.1f} GB of transport do not fit a buffer of {}; the "
                                       "host gathers it instead, which takes longer",
                                       double(entries) * sizeof(uint32_t) * 1e-9, device.name()));
    return false;
}

} // namespace

uint64_t bounceBytes(const Asset& asset, const Appearance& appearance) {
    constexpr uint64_t kEntryBytes = sizeof(uint16_t) + sizeof(uint32_t),
                       kRowBytes = sizeof(float) + sizeof(uint64_t);
    const auto rowsBytes = [](int rows, int terms) {
        return uint64_t(rows) * (uint64_t(bounceEntries(terms)) * kEntryBytes + kRowBytes);
    };
    uint64_t bytes = 0;
    for (size_t number = 0; number < asset.parts.size(); number++) {
        const AssetPart& part = asset.parts[number];
        const int bound = part.sets[appearance[number].set].brdf.terms, all = termCount(part);
        // Direct transport, that with the previous bounce, and bounced rows of all sets.
        bytes += part.mesh.vertexCount() * (2 * rowsBytes(bound, bound) + rowsBytes(all, all));
    }
    return bytes;
}

void BouncedTransport::addTo(std::span<BakedRows> sets, const Asset& asset, size_t part, uint32_t first,
                             int most) const {
    const int faceSize = asset.faceSize;
    const size_t coefficients = 6 * size_t(faceSize) * size_t(faceSize);
    for (size_t set = 0; set < sets.size(); set++) {
        const int kept = std::min(rowEntries(asset, asset.parts[part].sets[set]), most);
        const SparseTransport& bounced = mRows[part][set];
        const SparseTransport& direct = sets[set].transport;
        const auto addRow = [&](size_t row, RowSum& sum) {
            sum.add(direct, row, 1);
            sum.add(bounced, size_t(first) * bounced.terms + row, float(kBounceFaceSize) / float(faceSize),
                    [&](uint16_t index) { return coefficientOfBounce(index, faceSize); });
            RowSum::Energies energies;
            PackedRow packed = sum.pack(kept, &energies);
            TransportLosses& losses = sets[set].losses[row];
            losses.total += energies.total - energyOf(direct, row);
            losses.dropped += energies.dropped;
            losses.quantized += energies.quantized;
            return packed;
        };
        sets[set].transport = rowsInParallel(direct.vertices, direct.terms, coefficients, addRow);
    }
}

void BouncedTransport::addTo(std::span<vec3> coefficients, size_t part, size_t set, size_t row,
                             int faceSize) const {
    std::vector<vec3> bounced(kBounceCoefficients, vec3(0));
    mRows[part][set].dequantizeRow(row, bounced);
    for (size_t i = 0; i < bounced.size(); i++)
        coefficients[coefficientOfBounce(uint16_t(i), faceSize)] +=
            bounced[i] * (float(kBounceFaceSize) / float(faceSize));
}

std::shared_ptr<const BouncedTransport> bounceTransport(const vk::Device& device, BakePlan& plan,
                                                        const BakeLimits& limits, BakeObserver& observer,
                                                        BakeTimes& times,
                                                        std::vector<SparseTransport>* lastSources) {
    const Appearance bound = defaultAppearance(plan.asset);
    expectMemory(plan, bound);
    StageObserver stage(observer, BakeStage::Bounces);
    EvenResponses responses;
    std::vector<SparseTransport> direct = bakeSources(device, plan, bound, limits, stage, times, responses);
    const Stopwatch watch;
    const BounceHits hits(plan.asset, bound);
    logHeld(plan, hits);
    std::optional<BounceGatherPass> onDevice;
    if (gathersOnDevice(device, direct)) onDevice.emplace(device, hits);
    std::vector<std::vector<SparseTransport>> bounced;
    const int bounces = plan.options.bounces;
    const uint64_t all = plan.vertices();
    for (int bounce = 0; bounce < bounces; bounce++) {
        std::vector<SparseTransport> from;
        for (size_t part = 0; part < direct.size(); part++) {
            from.push_back(bounce == 0 ? direct[part] : sumOf(direct[part], bounced[part][bound[part].set]));
            if (bounce == bounces - 1) direct[part] = {};
        }
        bounced.clear();
        const Stopwatch bounceWatch;
        observer.stage(BakeStage::Bounces, "");
        const auto report = [&](uint64_t done) {
            const double perSecond = double(done) / std::max(bounceWatch.seconds(), 1e-9);
            const auto left = double(all - done + all * uint64_t(bounces - 1 - bounce));
            observer.progress({.vertices = all,
                               .done = done,
                               .fraction = double(done) / double(all),
                               .verticesPerSecond = perSecond,
                               .secondsLeft = left / perSecond});
            return !observer.wantsStop();
        };
        bounced = onDevice ? onDevice->gather(from, report) : BounceGather(hits).gather(from, report);
        if (bounced.empty()) throw BakeStopped("stopped");
        if (lastSources && bounce == bounces - 1) *lastSources = std::move(from);
    }
    storeShares(plan.asset, responses, bounced);
    const vk::PassTimes onDeviceTimes = onDevice ? onDevice->times() : vk::PassTimes();
    for (const auto& [name, seconds] : onDeviceTimes) vk::addTime(times.device, name, seconds);
    times.bounces += watch.seconds() - vk::secondsOf(onDeviceTimes);
    return std::make_shared<const BouncedTransport>(std::move(bounced));
}

std::shared_ptr<const BouncedTransport> bouncedTransportOf(const vk::Device& device, const Asset& asset,
                                                           BakeObserver& observer,
                                                           std::vector<SparseTransport>* lastSources) {
    BakePlan plan = planOf(asset);
    plan.options = optionsOf(asset);
    plan.options.visibilityMethod = usableMethod(device, plan.options.visibilityMethod);
    BakeTimes times;
    return bounceTransport(device, plan, {}, observer, times, lastSources);
}

} // namespace relume
