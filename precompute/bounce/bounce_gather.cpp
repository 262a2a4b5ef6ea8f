#include "precompute/bounce/bounce_gather.h"

#include "precompute/thread_limit.h"
#include "precompute/transport/row_sum.h"

#include <Eigen/Core>
#include <algorithm>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace relume {

// Outside anonymous namespaces, as BounceGather::Room holds them: values of up to kTerms terms in three
// channels, side by side, so that an instruction serves all terms.
struct TermGroup {
    static constexpr size_t kTerms = 8;
    using Values = Eigen::Array<float, kTerms, 1>;

    Values red = Values::Zero(), green = Values::Zero(), blue = Values::Zero();

    void set(size_t term, vec3 value) {
        red[Eigen::Index(term)] = value.x;
        green[Eigen::Index(term)] = value.y;
        blue[Eigen::Index(term)] = value.z;
    }
    vec3 get(size_t term) const {
        return {red[Eigen::Index(term)], green[Eigen::Index(term)], blue[Eigen::Index(term)]};
    }
    void add(const TermGroup& light, vec3 value) {
        red += light.red * value.x;
        green += light.green * value.y;
        blue += light.blue * value.z;
    }
};

// Adds the entries of a row, times `weights`, to `total`, which has a group per coefficient. Gathering spends
// most of its time here, so the weights are a copy, which the compiler keeps in registers.
static void addRow(std::span<const uint16_t> indices, std::span<const uint32_t> values,
                   const TermGroup weights, TermGroup* total) {
    for (size_t i = 0; i < indices.size(); i++)
        total[indices[i]].add(weights, vec3(unpackCoefficient(values[i])));
}

// Returns the number of groups that hold so many terms.
static size_t groupsFor(int terms) { return (size_t(terms) + TermGroup::kTerms - 1) / TermGroup::kTerms; }

std::optional<uint16_t> bounceCoefficient(uint16_t coefficient, int size) {
    const int face = coefficient / (size * size), y = coefficient / size % size, x = coefficient % size;
    if (x >= kBounceFaceSize || y >= kBounceFaceSize) return std::nullopt;
    return uint16_t((face * kBounceFaceSize + y) * kBounceFaceSize + x);
}

uint16_t coefficientOfBounce(uint16_t coefficient, int size) {
    const int face = coefficient / (kBounceFaceSize * kBounceFaceSize),
              y = coefficient / kBounceFaceSize % kBounceFaceSize, x = coefficient % kBounceFaceSize;
    return uint16_t((face * size + y) * size + x);
}

SparseTransport bounceRows(const SparseTransport& rows, int faceSize) {
    std::vector<std::optional<uint16_t>> places; // by coefficient
    for (int i = 0; i < 6 * faceSize * faceSize; i++)
        places.push_back(bounceCoefficient(uint16_t(i), faceSize));
    SparseTransport coarse{rows.vertices, rows.terms, {0}, {}, {}, {}};
    for (size_t row = 0; row < rows.rows(); row++) {
        for (uint64_t entry = rows.rowStarts[row]; entry < rows.rowStarts[row + 1]; entry++)
            if (const auto place = places[rows.indices[entry]]) {
                coarse.indices.push_back(*place);
                coarse.values.push_back(rows.values[entry]);
            }
        coarse.scales.push_back(rows.scales[row] * float(faceSize) / kBounceFaceSize);
        coarse.rowStarts.push_back(coarse.entries());
    }
    return coarse;
}

// A thread's buffers, reused from vertex to vertex.
struct BounceGather::Room {
    explicit Room(int mostTerms)
        : values(size_t(mostTerms)), light(BounceHits::kRays * groupsFor(mostTerms)),
          views(BounceHits::kRays * kMostTerms), weights(groupsFor(mostTerms)),
          total(weights.size() * kBounceCoefficients), sum(kBounceCoefficients) {}

    // The vertex whose rows a ray brings, and the number of the ray among those with a hit.
    struct Source {
        uint32_t part, vertex, ray;
        auto operator<=>(const Source&) const = default;
    };

    std::vector<Source> sources;
    std::vector<vec3> values;       // of a ray: g of each term, times the ray's weight
    std::vector<TermGroup> light;   // the same, per ray and group
    std::vector<vec3> views;        // per ray and term of its hit
    std::vector<TermGroup> weights; // per group: of a row
    std::vector<TermGroup> total;   // per group and coefficient: bounced light
    RowSum sum;                     // of a row
};

void BounceGather::gatherVertex(size_t number, uint32_t vertex, std::span<const SparseTransport> from,
                                Room& room, std::span<SparseTransport> rows) const {
    const auto terms = size_t(termCount(mHits.asset().parts[number]));
    const size_t groups = groupsFor(int(terms));
    room.sources.clear();
    std::fill_n(room.total.begin(), groups * kBounceCoefficients, TermGroup{});
    mHits.find(number, vertex, [&](const BounceHit& hit) {
        const size_t ray = room.sources.size();
        room.sources.push_back({hit.part, hit.vertex, uint32_t(ray)});
        std::fill_n(&room.light[ray * groups], groups, TermGroup{});
        mHits.lookupLight(number, hit.direction, std::span(room.values).first(terms));
        for (size_t term = 0; term < terms; term++)
            room.light[ray * groups + term / TermGroup::kTerms].set(term % TermGroup::kTerms,
                                                                    room.values[term]);
        std::copy_n(hit.views.begin(), from[hit.part].terms, &room.views[ray * kMostTerms]);
    });
    // Rows are added once for all rays that meet their vertex.
    std::ranges::sort(room.sources);
    for (auto first = room.sources.begin(), end = first; first != room.sources.end(); first = end) {
        const uint32_t part = first->part, source = first->vertex;
        end = std::find_if(first, room.sources.end(),
                           [&](const Room::Source& s) { return s.part != part || s.vertex != source; });
        const SparseTransport& sent = from[part];
        for (uint32_t term = 0; term < sent.terms; term++) {
            const size_t row = size_t(source) * sent.terms + term;
            std::fill_n(room.weights.begin(), groups, TermGroup{});
            for (auto met = first; met != end; ++met) {
                const vec3 step =
                    room.views[met->ray * kMostTerms + term] * (sent.scales[row] * kCoefficientUnit);
                for (size_t group = 0; group < groups; group++)
                    room.weights[group].add(room.light[met->ray * groups + group], step);
            }
            const size_t begin = sent.rowStarts[row], count = sent.rowStarts[row + 1] - begin;
            for (size_t group = 0; group < groups; group++)
                addRow(std::span(sent.indices).subspan(begin, count),
                       std::span(sent.values).subspan(begin, count), room.weights[group],
                       &room.total[group * kBounceCoefficients]);
        }
    }

    const int kept = bounceEntries(int(terms));
    size_t row = 0;
    for (SparseTransport& own : rows) {
        for (uint32_t term = 0; term < own.terms; term++, row++) {
            const TermGroup* total = &room.total[row / TermGroup::kTerms * kBounceCoefficients];
            if (!room.sources.empty())
                for (size_t i = 0; i < kBounceCoefficients; i++)
                    room.sum.add(i, total[i].get(row % TermGroup::kTerms));
            appendRow(own, room.sum.pack(kept));
        }
        own.vertices++;
    }
}

std::vector<SparseTransport> emptyBouncedRows(const AssetPart& part) {
    std::vector<SparseTransport> rows;
    for (const MaterialSet& set : part.sets) rows.push_back(emptyRows(uint32_t(set.brdf.terms)));
    return rows;
}

std::vector<std::vector<SparseTransport>> BounceGather::gather(std::span<const SparseTransport> from,
                                                               const BounceReport& report) const {
    constexpr uint32_t kTogether = 8, kPerThread = 256; // vertices: of a task, and between reports
    const auto batch = uint32_t(kPerThread * allowedThreads());
    int mostTerms = 0;
    for (const AssetPart& part : mHits.asset().parts) mostTerms = std::max(mostTerms, termCount(part));
    tbb::enumerable_thread_specific<Room> rooms(mostTerms);
    std::vector<std::vector<SparseTransport>> gathered;
    uint64_t done = 0;
    for (size_t number = 0; number < mHits.asset().parts.size(); number++) {
        const AssetPart& part = mHits.asset().parts[number];
        std::vector<SparseTransport>& all = gathered.emplace_back(emptyBouncedRows(part));
        const auto vertices = uint32_t(part.mesh.vertexCount());
        for (uint32_t first = 0; first < vertices; first += batch) {
            const uint32_t end = std::min(first + batch, vertices);
            std::vector<std::vector<SparseTransport>> portions((end - first + kTogether - 1) / kTogether,
                                                               emptyBouncedRows(part));
            tbb::parallel_for(size_t(0), portions.size(), [&](size_t portion) {
                const auto begin = uint32_t(first + portion * kTogether);
                for (uint32_t vertex = begin; vertex < std::min(begin + kTogether, end); vertex++)
                    gatherVertex(number, vertex, from, rooms.local(), portions[portion]);
            });
            for (const std::vector<SparseTransport>& portion : portions)
                for (size_t set = 0; set < all.size(); set++) appendRows(all[set], portion[set]);
            done += end - first;
            if (!report(done)) return {};
        }
    }
    return gathered;
}

} // namespace relume
