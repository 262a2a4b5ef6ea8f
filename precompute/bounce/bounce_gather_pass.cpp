#include "precompute/bounce/bounce_gather_pass.h"

#include "engine/vk/upload.h"
#include "precompute/transport/row_sum.h"
#include "shaders/bounce_gather_comp.h"
#include "shaders/shared/bake.h"

#include <algorithm>
#include <future>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr int kPackedFaceSize = 32;                   // the smallest that the kernels pack
constexpr uint64_t kBatchBytes = uint64_t(256) << 20; // of coefficients and hits
constexpr uint32_t kMostVertices = 256;
constexpr uint32_t kMostTogether = 12; // terms for which a lane has registers

// Returns the work-group size, which divides kBounceCoefficients.
uint32_t lanesFor(const vk::Device& device) {
    for (const uint32_t lanes : {512u, 256u})
        if (device.limits().maxComputeWorkGroupInvocations >= lanes &&
            device.limits().maxComputeWorkGroupSize[0] >= lanes)
            return lanes;
    return 128; // every device has as many
}

} // namespace

// A buffer that the host fills and the device reads often; outside the anonymous namespace, as HitBuffers
// holds some.
struct StagedBuffer {
    StagedBuffer(const vk::Device& device, uint64_t bytes, std::string_view name)
        : staging(device, bytes, vk::BufferUse::Upload, name),
          buffer(device, bytes, vk::BufferUse::Device, name) {}

    template <typename T>
    std::span<T> map() const {
        return staging.map<T>();
    }
    void recordCopy(vk::Commands& commands, uint64_t bytes) const {
        if (bytes > 0) commands.copy(staging, buffer, bytes);
    }

    vk::Buffer staging, buffer;
};

// The rows that light others, those of all parts one after another.
struct BounceGatherPass::Sources {
    Sources(const vk::Device& device, std::span<const SparseTransport> from);

    std::span<const SparseTransport> rows; // per part
    std::vector<uint32_t> firstRows;       // per part
    uint32_t mostTerms = 1;
    vk::Buffer starts, indices, values;
};

BounceGatherPass::Sources::Sources(const vk::Device& device, std::span<const SparseTransport> from)
    : rows(from) {
    std::vector<uint32_t> rowStarts = {0}, allValues;
    std::vector<uint16_t> allIndices;
    for (const SparseTransport& part : from) {
        const auto before = uint32_t(allValues.size());
        firstRows.push_back(uint32_t(rowStarts.size() - 1));
        mostTerms = std::max(mostTerms, part.terms);
        for (size_t row = 0; row < part.rows(); row++)
            rowStarts.push_back(before + uint32_t(part.rowStarts[row + 1]));
        allIndices.insert(allIndices.end(), part.indices.begin(), part.indices.end());
        allValues.insert(allValues.end(), part.values.begin(), part.values.end());
    }
    // Uploads take whole words, and at least 16 bytes.
    allIndices.resize(std::max<size_t>(allIndices.size() + allIndices.size() % 2, 8));
    allValues.resize(std::max<size_t>(allValues.size(), 4));
    rowStarts.resize(std::max<size_t>(rowStarts.size(), 4), rowStarts.back());
    starts = vk::upload<uint32_t>(device, rowStarts, "source row starts");
    indices = vk::upload<uint16_t>(device, allIndices, "source indices");
    values = vk::upload<uint32_t>(device, allValues, "source values");
}

// A batch's hits, which the host finds and the device reads.
struct BounceGatherPass::HitBuffers {
    HitBuffers(const vk::Device& device, uint32_t vertices, uint32_t terms, uint32_t mostSourceTerms)
        : starts(device, (vertices + 1) * sizeof(uint32_t), "hit starts"),
          hits(device, vertices * BounceHits::kRays * sizeof(shared::SourceHit), "hits"),
          steps(device, vertices * BounceHits::kRays * mostSourceTerms * sizeof(vec3), "hit steps"),
          light(device, vertices * BounceHits::kRays * terms * sizeof(vec4), "hit light") {}

    // Finds the hits of vertices [first, first + count) of a part.
    void find(const BounceHits& scene, const Sources& sources, uint32_t part, uint32_t terms, uint32_t first,
              uint32_t count);

    StagedBuffer starts, hits, steps, light;
    std::vector<std::vector<BounceHit>> found; // per vertex; kept from batch to batch for its memory
};

void BounceGatherPass::HitBuffers::find(const BounceHits& scene, const Sources& sources, uint32_t part,
                                        uint32_t terms, uint32_t first, uint32_t count) {
    found.resize(std::max<size_t>(found.size(), count));
    tbb::parallel_for(0u, count, [&](uint32_t i) {
        found[i].clear();
        scene.find(part, first + i, [&](const BounceHit& hit) { found[i].push_back(hit); });
    });
    const std::span<uint32_t> hitStarts = starts.map<uint32_t>();
    hitStarts[0] = 0;
    for (uint32_t i = 0; i < count; i++) hitStarts[i + 1] = hitStarts[i] + uint32_t(found[i].size());
    tbb::parallel_for(0u, count, [&](uint32_t i) {
        std::vector<vec3> reflected(terms);
        for (size_t j = 0; j < found[i].size(); j++) {
            const BounceHit& hit = found[i][j];
            const size_t number = hitStarts[i] + j;
            const SparseTransport& from = sources.rows[hit.part];
            const size_t firstRow = size_t(hit.vertex) * from.terms; // of its part
            vec3 most(0);                                            // of the radiance of any coefficient
            for (uint32_t row = 0; row < from.terms; row++)
                most += glm::abs(hit.views[row]) * from.scales[firstRow + row];
            // Rounding adds less than one step per row to 2³⁰.
            const float unit = std::max({most.x, most.y, most.z}) * 0x1p-30f;
            const bool isDark = unit < 1e-36f;
            hits.map<shared::SourceHit>()[number] = {sources.firstRows[hit.part] + uint32_t(firstRow),
                                                     isDark ? 0 : from.terms, isDark ? 0 : unit};
            for (uint32_t row = 0; row < (isDark ? 0 : from.terms); row++)
                steps.map<vec3>()[number * sources.mostTerms + row] =
                    hit.views[row] * (from.scales[firstRow + row] / unit) * kCoefficientUnit;
            scene.lookupLight(part, hit.direction, reflected);
            for (uint32_t term = 0; term < terms; term++)
                light.map<vec4>()[number * terms + term] = vec4(reflected[term], 0);
        }
    });
}

// The kernels and buffers for batches of vertices of one part.
struct BounceGatherPass::PartPass {
    PartPass(const vk::Device& device, const AssetPart& part, uint32_t mostSourceTerms);

    // Gathers to `count` vertices from hits that are found, and waits.
    void run(vk::Commands& commands, const Sources& sources, const HitBuffers& found, uint32_t count) const;
    // Appends the rows of the last run to those of the part's sets.
    void collect(uint32_t count, std::vector<SparseTransport>& rows) const;

    uint32_t terms; // of all sets of the part
    uint32_t termGroups;
    uint32_t vertices; // of a batch
    PackingPass packing;
    PackedRows packed;
    vk::ComputeProgram gather;

  private:
    static uint32_t batchOf(const vk::Device& device, const AssetPart& part, uint32_t mostSourceTerms);
};

uint32_t BounceGatherPass::PartPass::batchOf(const vk::Device& device, const AssetPart& part,
                                             uint32_t mostSourceTerms) {
    const auto terms = uint64_t(termCount(part));
    const uint64_t rowBytes = terms * PackingPass::coefficientBytes(kPackedFaceSize),
                   hitBytes = BounceHits::kRays * (sizeof(shared::SourceHit) +
                                                   mostSourceTerms * sizeof(vec3) + terms * sizeof(vec4));
    const uint64_t most = std::min({uint64_t(kMostVertices), uint64_t(part.mesh.vertexCount()),
                                    kBatchBytes / (rowBytes + hitBytes),
                                    device.largestStorageBuffer() / std::max(rowBytes, hitBytes)});
    return uint32_t(std::max<uint64_t>(most, 1));
}

BounceGatherPass::PartPass::PartPass(const vk::Device& device, const AssetPart& part,
                                     uint32_t mostSourceTerms)
    : terms(uint32_t(termCount(part))), termGroups((terms + kMostTogether - 1) / kMostTogether),
      vertices(batchOf(device, part, mostSourceTerms)),
      packing(device, kPackedFaceSize, bounceEntries(int(terms)), uint64_t(vertices) * terms,
              uint64_t(vertices) * terms, 64),
      packed(device, uint64_t(vertices) * terms, bounceEntries(int(terms))),
      gather(device, bounce_gather_comp_spirv, {(terms + termGroups - 1) / termGroups, lanesFor(device)},
             "bounce gather") {}

void BounceGatherPass::PartPass::run(vk::Commands& commands, const Sources& sources, const HitBuffers& found,
                                     uint32_t count) const {
    using enum vk::Stage;
    const uint64_t hits = found.starts.map<uint32_t>()[count];
    commands.begin();
    commands.pass("bounce upload", [&] {
        found.starts.recordCopy(commands, (count + 1) * sizeof(uint32_t));
        found.hits.recordCopy(commands, hits * sizeof(shared::SourceHit));
        found.steps.recordCopy(commands, hits * sources.mostTerms * sizeof(vec3));
        found.light.recordCopy(commands, hits * terms * sizeof(vec4));
        commands.barrier(Transfer, Compute);
    });
    commands.pass("bounce gather", [&] {
        commands.dispatch(gather,
                          {found.starts.buffer, found.hits.buffer, found.steps.buffer, found.light.buffer,
                           sources.starts, sources.indices, sources.values, packing.coefficients(),
                           packing.summaries()},
                          shared::BounceGatherPush{terms, sources.mostTerms},
                          {count * gather.groupSize()[0], termGroups, 1});
    });
    packing.recordSelection(commands, packed, count * terms, 0);
    packing.recordCompaction(commands, packed, count * terms);
    commands.barrier(Compute, Host);
    commands.submitAndWait();
}

void BounceGatherPass::PartPass::collect(uint32_t count, std::vector<SparseTransport>& rows) const {
    std::vector<SparseTransport> fine;
    for (const SparseTransport& set : rows) fine.push_back(emptyRows(set.terms));
    std::vector<TransportLosses> losses;
    uint64_t entry = 0;
    for (uint32_t i = 0, row = 0; i < count; i++)
        for (SparseTransport& set : fine) {
            for (uint32_t term = 0; term < set.terms; term++, row++) packed.append(row, entry, set, losses);
            set.vertices++;
        }
    for (size_t set = 0; set < rows.size(); set++)
        appendRows(rows[set], bounceRows(fine[set], kPackedFaceSize));
}

BounceGatherPass::BounceGatherPass(const vk::Device& device, const BounceHits& hits)
    : mDevice(device), mHits(hits), mCommands(device, "bounces") {}

std::vector<std::span<const uint32_t>> BounceGatherPass::kernels() { return {bounce_gather_comp_spirv}; }

bool BounceGatherPass::canGatherFrom(const vk::Device& device, uint64_t entries) {
    return entries <= device.largestStorageBuffer() / sizeof(uint32_t);
}

std::vector<std::vector<SparseTransport>> BounceGatherPass::gather(std::span<const SparseTransport> from,
                                                                   const BounceReport& report) {
    const Sources sources(mDevice, from);
    std::vector<std::vector<SparseTransport>> gathered;
    uint64_t done = 0;
    const Asset& asset = mHits.asset();
    for (uint32_t number = 0; number < asset.parts.size(); number++) {
        const AssetPart& part = asset.parts[number];
        std::vector<SparseTransport>& rows = gathered.emplace_back(emptyBouncedRows(part));
        const auto vertices = uint32_t(part.mesh.vertexCount());
        const PartPass pass(mDevice, part, sources.mostTerms);
        // While the device gathers to one batch, the host finds the hits of the next.
        HitBuffers buffers[] = {{mDevice, pass.vertices, pass.terms, sources.mostTerms},
                                {mDevice, pass.vertices, pass.terms, sources.mostTerms}};
        std::future<void> running; // last: waits before what it uses is gone
        uint32_t count = 0;        // vertices of the running batch
        const auto finish = [&] {
            if (count == 0) return;
            running.get();
            pass.collect(count, rows);
            done += count;
        };
        for (uint32_t first = 0, batch = 0; first < vertices; first += pass.vertices, batch++) {
            HitBuffers& own = buffers[batch % 2];
            const uint32_t next = std::min(pass.vertices, vertices - first);
            own.find(mHits, sources, number, pass.terms, first, next);
            finish();
            if (!report(done)) return {};
            count = next;
            running = std::async(std::launch::async, [&, next] { pass.run(mCommands, sources, own, next); });
        }
        finish();
        if (!report(done)) return {};
    }
    return gathered;
}

} // namespace relume
