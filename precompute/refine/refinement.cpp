#include "precompute/refine/refinement.h"

#include "engine/base/check.h"
#include "precompute/refine/refined_part.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>

namespace relume {

namespace {

// Of the error, what is worked on in one round: the edges that make most of it.
constexpr double kRoundShare = 0.35;
// A round leaves so much of the squared error that is wanted, that the last rounds are few.
constexpr double kAim = 0.9;
// It ends as well where edges that may be split make less than this of the squared error that is wanted.
constexpr double kLeastShare = 0.1;
// In visibility offsets. What lies closer is told apart by the offset rather than by the scene.
constexpr float kShortestEdge = 8;

// Numbers positions, whichever part they belong to.
class Places {
  public:
    uint32_t number(vec3 position) {
        const auto bits = [](float x) { return std::bit_cast<uint32_t>(x + 0.0f); }; // -0 is 0
        const std::array key = {bits(position.x), bits(position.y), bits(position.z)};
        return mNumbers.try_emplace(key, uint32_t(mNumbers.size())).first->second;
    }

  private:
    std::map<std::array<uint32_t, 3>, uint32_t> mNumbers;
};

// Edges that lie on each other, and what they add up to. Errors are squared and times area.
struct EdgeGain {
    Edge places;
    double error = 0;
    uint32_t sides = 0; // as many vertices does a split take
};

class Refiner {
  public:
    Refiner(std::vector<AssetPart>& parts, const Mesh& occluder, float offset, BakeObserver& observer)
        : mVisibility(occluder, TransportProbe::kVisibilitySize), mOffset(offset), mObserver(observer) {
        mParts.reserve(parts.size());
        for (AssetPart& part : parts) mParts.emplace_back(part, mVisibility, mLights, offset);
        mPlaces.resize(parts.size());
    }

    RefinementRecord run(double wanted) {
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
            const auto start = std::chrono::steady_clock::now();
            part.probe([&](size_t done, size_t count) {
                if (mObserver.wantsStop()) throw BakeStopped("stopped while refining");
                if (done == 0) return;
                const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
                const double rate = double(done) / taken.count();
                mObserver.progress({.vertices = count,
                                    .done = done,
                                    .fraction = double(done) / double(count),
                                    .verticesPerSecond = rate,
                                    .secondsLeft = double(count - done) / rate});
            });
            const std::vector<vec3>& positions = part.mesh().positions;
            std::vector<uint32_t>& places = mPlaces[number];
            for (size_t i = places.size(); i < positions.size(); i++)
                places.push_back(mNumbers.number(positions[i]));
        }
    }

    Edge placesOf(size_t part, Edge edge) const {
        return {mPlaces[part][edge.first], mPlaces[part][edge.second]};
    }

    bool isSplittable(size_t part, Edge edge) const {
        const Mesh& mesh = mParts[part].mesh();
        const Edge places = placesOf(part, edge);
        return places.first != places.second &&
               glm::distance(mesh.positions[edge.first], mesh.positions[edge.second]) >=
                   kShortestEdge * mOffset;
    }

    void measure() {
        mError = mEnergy = 0;
        std::map<Edge, EdgeGain> gains;
        for (size_t part = 0; part < mParts.size(); part++)
            for (const ProbedEdge& edge : mParts[part].edges()) {
                mError += edge.area * edge.squaredError;
                mEnergy += edge.area * edge.squaredAnswer;
                if (!isSplittable(part, edge.edge)) continue;
                const Edge places = placesOf(part, edge.edge);
                EdgeGain& gain = gains.try_emplace(places, EdgeGain{places}).first->second;
                gain.error += edge.area * edge.squaredError;
                gain.sides++;
            }
        mGains.clear();
        for (const auto& [places, gain] : gains) mGains.push_back(gain);
    }

    // Splits the edges that make most of the error for the vertices that it takes. False if that leads
    // nowhere.
    bool splitWorst(double wanted) {
        std::ranges::stable_sort(mGains, std::greater(), [](const EdgeGain& g) { return g.error / g.sides; });
        double within = 0, sum = 0;
        for (const EdgeGain& gain : mGains) within += gain.error;
        if (within < kLeastShare * wanted) return false;
        const double share = std::min(kRoundShare * mError, mError - kAim * wanted);
        uint64_t room = kMostRefinedVertices - vertices();
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
    double mError = 0, mEnergy = 0;             // squared and times area
    std::vector<EdgeGain> mGains;
};

} // namespace

RefinementRecord refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset,
                        double wanted, BakeObserver& observer) {
    RELUME_CHECK(wanted > 0);
    uint64_t given = 0;
    for (const AssetPart& part : parts) given += part.mesh.vertexCount();
    if (given > kMostRefinedVertices)
        throw Error("--refine: expected at most {} vertices to begin with, found {}; bake without it",
                    kMostRefinedVertices, given);
    return Refiner(parts, occluder, visibilityOffset, observer).run(wanted);
}

} // namespace relume
