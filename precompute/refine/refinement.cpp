#include "precompute/refine/refinement.h"

#include "engine/base/check.h"
#include "engine/base/stopwatch.h"
#include "precompute/refine/refined_part.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/core.h>
#include <map>
#include <optional>
#include <set>

namespace relume {

namespace {

// Share of the error that is worked on per round, by the edges that contribute most.
constexpr double kRoundShare = 0.35;
// A round aims at this share of the wanted squared error, so that few last rounds are needed.
constexpr double kAim = 0.9;
// Refinement also ends if splittable edges contribute less than this share of the wanted squared error.
constexpr double kLeastProgress = 0.1;
// Shortest edge that is split, in visibility offsets. Closer points differ by the offset rather than by the
// scene.
constexpr float kShortestEdge = 8;

// Assigns numbers to positions, across all parts.
class Places {
  public:
    uint32_t number(vec3 position) {
        return mNumbers.try_emplace(keyOf(position), uint32_t(mNumbers.size())).first->second;
    }
    // Returns none if the position has no number.
    std::optional<uint32_t> find(vec3 position) const {
        const auto found = mNumbers.find(keyOf(position));
        return found == mNumbers.end() ? std::nullopt : std::optional(found->second);
    }

  private:
    using Key = std::array<uint32_t, 3>;
    static Key keyOf(vec3 position) {
        const auto bits = [](float x) { return std::bit_cast<uint32_t>(x + 0.0f); }; // turns -0 into 0
        return {bits(position.x), bits(position.y), bits(position.z)};
    }

    std::map<Key, uint32_t> mNumbers;
};

// Edges of all parts that coincide, and their total error: squared, times area and their parts' weights.
struct EdgeGain {
    Edge places;
    double error = 0;
    uint32_t sides = 0; // number of coinciding edges; a split adds as many vertices
};

class Refiner {
  public:
    Refiner(const std::vector<AssetPart*>& parts, const std::vector<const Mesh*>& others,
            const Mesh& occluder, float offset, BakeObserver& observer)
        : mVisibility(occluder, TransportProbe::kVisibilitySize), mOffset(offset), mObserver(observer),
          mWhiteEnergy(mLights.whiteEnergy()) {
        mParts.reserve(parts.size());
        for (AssetPart* part : parts) mParts.emplace_back(*part, mVisibility, mLights, offset);
        mPlaces.resize(parts.size());
        numberPlaces();
        for (const Mesh* mesh : others) keepEdges(*mesh);
    }

    RefinementRecord run(double wanted, uint64_t mostVertices) {
        mMostVertices = mostVertices;
        RefinementRecord record{.wanted = wanted, .startVertices = vertices()};
        mObserver.stage(BakeStage::Refinement, "");
        for (bool isFirst = true;; isFirst = false) {
            probe();
            measure();
            record.error = mEnergy > 0 ? std::sqrt(mError / mEnergy) : 0;
            if (isFirst) record.startError = record.error;
            if (record.error <= wanted || !splitWorst(wanted * wanted * mEnergy)) break;
        }
        record.vertices = vertices();
        return record;
    }

  private:
    uint64_t vertices() const {
        uint64_t count = 0;
        for (const RefinedPart& part : mParts) count += part.mesh().vertexCount();
        return count;
    }

    void probe() {
        for (size_t number = 0; number < mParts.size(); number++) {
            RefinedPart& part = mParts[number];
            const Stopwatch watch;
            part.probe([&](size_t done, size_t count) {
                if (mObserver.wantsStop()) throw BakeStopped("stopped while refining");
                if (done == 0) return;
                const double rate = double(done) / watch.seconds();
                mObserver.progress({.vertices = count,
                                    .done = done,
                                    .fraction = double(done) / double(count),
                                    .verticesPerSecond = rate,
                                    .secondsLeft = double(count - done) / rate});
            });
        }
        numberPlaces();
    }

    void numberPlaces() {
        for (size_t number = 0; number < mParts.size(); number++) {
            const std::vector<vec3>& positions = mParts[number].mesh().positions;
            std::vector<uint32_t>& places = mPlaces[number];
            for (size_t i = places.size(); i < positions.size(); i++)
                places.push_back(mNumbers.number(positions[i]));
        }
    }

    // Keeps edges of refined parts whole where they coincide with those of an unrefined mesh.
    void keepEdges(const Mesh& mesh) {
        std::vector<std::optional<uint32_t>> places;
        for (const vec3& position : mesh.positions) places.push_back(mNumbers.find(position));
        for (const uvec3& t : mesh.triangles)
            for (const auto& [a, b] : {std::pair(t.x, t.y), std::pair(t.y, t.z), std::pair(t.z, t.x)})
                if (places[a] && places[b]) mKept.insert({*places[a], *places[b]});
    }

    Edge placesOf(size_t part, Edge edge) const {
        return {mPlaces[part][edge.first], mPlaces[part][edge.second]};
    }

    bool isSplittable(size_t part, Edge edge) const {
        const Mesh& mesh = mParts[part].mesh();
        const Edge places = placesOf(part, edge);
        return places.first != places.second && !mKept.contains(places) &&
               glm::distance(mesh.positions[edge.first], mesh.positions[edge.second]) >=
                   kShortestEdge * mOffset;
    }

    // Returns the weight of a part's squared light. What reflects more than a white surface does, polished
    // metal or a clear coat above all, counts as if it reflected as much: else its peaks, which few eyes see,
    // take all vertices, and the ground keeps none for shadows.
    double energyWeight(const RefinedPart& part) const {
        double area = 0, energy = 0;
        for (const ProbedEdge& edge : part.edges()) {
            area += edge.area;
            energy += edge.area * edge.squaredResponse;
        }
        return area > 0 ? 1 / std::max(mWhiteEnergy, energy / area) : 0;
    }

    void measure() {
        mError = mEnergy = 0;
        std::map<Edge, EdgeGain> gains;
        for (size_t part = 0; part < mParts.size(); part++) {
            const double weight = energyWeight(mParts[part]);
            for (const ProbedEdge& edge : mParts[part].edges()) {
                const double error = weight * edge.area * edge.squaredError;
                mError += error;
                mEnergy += weight * edge.area * edge.squaredResponse;
                if (!isSplittable(part, edge.edge)) continue;
                const Edge places = placesOf(part, edge.edge);
                EdgeGain& gain = gains.try_emplace(places, EdgeGain{places}).first->second;
                gain.error += error;
                gain.sides++;
            }
        }
        mGains.clear();
        for (const auto& [places, gain] : gains) mGains.push_back(gain);
    }

    // Splits the edges of largest error per added vertex. Returns false if there is nothing worth splitting.
    bool splitWorst(double wanted) {
        std::ranges::stable_sort(mGains, std::greater(), [](const EdgeGain& g) { return g.error / g.sides; });
        double within = 0, sum = 0;
        for (const EdgeGain& gain : mGains) within += gain.error;
        if (within < kLeastProgress * wanted) return false;
        const double share = std::min(kRoundShare * mError, mError - kAim * wanted);
        uint64_t room = mMostVertices - std::min(mMostVertices, vertices());
        std::vector<Edge> chosen;
        for (const EdgeGain& gain : mGains) {
            if (sum >= share || !(gain.error > 0) || gain.sides > room) break;
            sum += gain.error;
            room -= gain.sides;
            chosen.push_back(gain.places);
        }
        std::ranges::sort(chosen);
        for (size_t part = 0; part < mParts.size(); part++) {
            std::vector<uint32_t> numbers;
            const std::vector<ProbedEdge>& edges = mParts[part].edges();
            for (uint32_t i = 0; i < edges.size(); i++)
                if (std::ranges::binary_search(chosen, placesOf(part, edges[i].edge))) numbers.push_back(i);
            mParts[part].split(numbers);
        }
        return !chosen.empty();
    }

    ProbeLights mLights;
    CpuVisibility mVisibility;
    float mOffset;
    BakeObserver& mObserver;
    std::vector<RefinedPart> mParts;
    Places mNumbers;
    std::vector<std::vector<uint32_t>> mPlaces; // per part and vertex
    std::set<Edge> mKept;                       // edges that stay whole, by places
    uint64_t mMostVertices = 0;
    double mWhiteEnergy;            // per area
    double mError = 0, mEnergy = 0; // squared, times area and weight
    std::vector<EdgeGain> mGains;
};

} // namespace

RefinementRecord refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset,
                        const RefinementGoal& goal, BakeObserver& observer) {
    RELUME_CHECK(goal.wanted > 0);
    std::vector<AssetPart*> refined;
    std::vector<const Mesh*> others;
    uint64_t given = 0, kept = 0;
    for (size_t number = 0; number < parts.size(); number++) {
        AssetPart& part = parts[number];
        if (goal.isRefined.empty() || goal.isRefined[number]) {
            refined.push_back(&part);
            given += part.mesh.vertexCount();
        } else {
            others.push_back(&part.mesh);
            kept += part.mesh.vertexCount();
        }
    }
    if (given > kMostRefinedVertices)
        throw Error(fmt::format(
            "--refine: expected at most {} vertices to begin with, found {}; bake with --refine off",
            kMostRefinedVertices, given));
    RefinementRecord record =
        Refiner(refined, others, occluder, visibilityOffset, observer).run(goal.wanted, goal.mostVertices);
    record.startVertices += kept;
    record.vertices += kept;
    return record;
}

} // namespace relume
