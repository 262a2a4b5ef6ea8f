#include "precompute/refine/refinement.h"

#include "engine/base/check.h"
#include "precompute/refine/edge_split.h"
#include "precompute/refine/transport_probe.h"

#include <algorithm>
#include <bit>
#include <map>
#include <spdlog/spdlog.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// Of the error, what is worked on in one round: the edges that make most of it.
constexpr double kRoundShare = 0.35;
constexpr float kShortestEdge = 8; // in visibility offsets: below, visibility is not known
constexpr size_t kProbesAtOnce = 512;

double squaredSum(const ProbeAnswers& answers) {
    double sum = 0;
    for (const float answer : answers) sum += double(answer) * double(answer);
    return sum;
}

// What interpolation makes of the middle of an edge, against what is there.
double squaredError(const ProbeAnswers& first, const ProbeAnswers& second, const ProbeAnswers& middle) {
    double sum = 0;
    for (size_t i = 0; i < middle.size(); i++) {
        const double difference = 0.5 * (double(first[i]) + double(second[i])) - double(middle[i]);
        sum += difference * difference;
    }
    return sum;
}

// Where a vertex is, whichever part it belongs to.
class Places {
  public:
    uint32_t of(vec3 position) {
        const auto bits = [](float x) { return std::bit_cast<uint32_t>(x + 0.0f); }; // -0 is 0
        const std::array key = {bits(position.x), bits(position.y), bits(position.z)};
        return mPlaces.try_emplace(key, uint32_t(mPlaces.size())).first->second;
    }

  private:
    std::map<std::array<uint32_t, 3>, uint32_t> mPlaces;
};

struct ProbedEdge {
    Edge edge;
    Edge place; // its ends, as places
    double area = 0; // a third of the triangles that have it
    bool isProbed = false;
    ProbeAnswers middle{};
    double squaredError = 0; // at the middle
};

struct RefinedPart {
    RefinedPart(AssetPart& assetPart, const CpuVisibility& visibility, const ProbeLights& lights)
        : part(assetPart), probe(assetPart, visibility, lights) {}

    AssetPart& part;
    TransportProbe probe;
    std::vector<uint32_t> places;      // of vertices
    std::vector<ProbeAnswers> answers; // of vertices
    std::vector<ProbedEdge> edges;     // sorted by edge
};

class Refiner {
  public:
    Refiner(std::vector<AssetPart>& parts, const Mesh& occluder, float offset, BakeObserver& observer)
        : mVisibility(occluder, TransportProbe::kVisibilitySize), mOffset(offset), mObserver(observer) {
        for (AssetPart& part : parts) mParts.emplace_back(part, mVisibility, mLights);
        for (RefinedPart& part : mParts) placeVertices(part);
    }

    Refinement run(double wanted) {
        Refinement result;
        result.startVertices = vertices();
        for (RefinedPart& part : mParts) probeVertices(part);
        for (int round = 0;; round++) {
            for (RefinedPart& part : mParts) findEdges(part), probeEdges(part);
            measure();
            result.error = std::sqrt(mError / mEnergy);
            if (round == 0) result.startError = result.error;
            if (!(result.error > wanted)) break;
            if (!splitWorst(wanted * wanted * mEnergy)) {
                result.isLimited = true;
                break;
            }
            spdlog::info("round {}: {} error {:.4f}, {} now", round, result.vertices, result.error, vertices());
        }
        result.vertices = vertices();
        return result;
    }

  private:
    uint64_t vertices() const {
        uint64_t count = 0;
        for (const RefinedPart& part : mParts) count += part.part.mesh.vertexCount();
        return count;
    }

    void placeVertices(RefinedPart& part) {
        const std::vector<vec3>& positions = part.part.mesh.positions;
        for (size_t i = part.places.size(); i < positions.size(); i++) part.places.push_back(mPlaces.of(positions[i]));
    }

    // Calls probe(i, workspace) for i < count on all threads.
    template <typename Probe>
    void probeAll(const RefinedPart& part, size_t count, const Probe& probe) {
        tbb::enumerable_thread_specific<TransportProbe::Workspace> workspaces(
            [&] { return part.probe.makeWorkspace(); });
        for (size_t first = 0; first < count; first += kProbesAtOnce) {
            if (mObserver.wantsStop()) throw BakeStopped("stopped");
            tbb::parallel_for(first, std::min(count, first + kProbesAtOnce),
                              [&](size_t i) { probe(i, workspaces.local()); });
        }
    }

    void probeVertices(RefinedPart& part) {
        const Mesh& mesh = part.part.mesh;
        part.answers.resize(mesh.vertexCount());
        probeAll(part, mesh.vertexCount(), [&](size_t i, TransportProbe::Workspace& own) {
            part.answers[i] =
                part.probe.answers(mesh.positions[i] + mOffset * mesh.normals[i], mesh.normals[i], own);
        });
    }

    // Keeps what is known of edges that are there still.
    void findEdges(RefinedPart& part) {
        const Mesh& mesh = part.part.mesh;
        std::vector<std::pair<Edge, double>> sides;
        for (const uvec3& t : mesh.triangles) {
            const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            const double third = double(glm::length(glm::cross(b - a, c - a))) / 6;
            for (const Edge edge : {Edge(t.x, t.y), Edge(t.y, t.z), Edge(t.z, t.x)}) sides.emplace_back(edge, third);
        }
        std::ranges::sort(sides);
        std::vector<ProbedEdge> edges;
        auto known = part.edges.begin();
        for (const auto& [edge, third] : sides) {
            if (edges.empty() || edges.back().edge != edge) {
                while (known != part.edges.end() && known->edge < edge) known++;
                if (known != part.edges.end() && known->edge == edge)
                    edges.push_back(*known);
                else
                    edges.push_back({edge, Edge(part.places[edge.first], part.places[edge.second])});
                edges.back().area = 0;
            }
            edges.back().area += third;
        }
        part.edges = std::move(edges);
    }

    void probeEdges(RefinedPart& part) {
        std::vector<ProbedEdge*> open;
        for (ProbedEdge& edge : part.edges)
            if (!edge.isProbed) open.push_back(&edge);
        probeAll(part, open.size(), [&](size_t i, TransportProbe::Workspace& own) {
            ProbedEdge& edge = *open[i];
            const EdgeMiddle middle = middleOf(part.part.mesh, edge.edge);
            edge.middle =
                part.probe.answers(middle.position + mOffset * middle.normal, middle.normal, own);
            edge.squaredError = squaredError(part.answers[edge.edge.first], part.answers[edge.edge.second], edge.middle);
            edge.isProbed = true;
        });
    }

    void measure() {
        mError = mEnergy = 0;
        for (const RefinedPart& part : mParts)
            for (const ProbedEdge& edge : part.edges) {
                mError += edge.area * edge.squaredError;
                mEnergy += edge.area * squaredSum(edge.middle);
            }
    }

    bool isSplittable(const RefinedPart& part, const ProbedEdge& edge) const {
        const Mesh& mesh = part.part.mesh;
        return edge.place.first != edge.place.second &&
               glm::length(mesh.positions[edge.edge.first] - mesh.positions[edge.edge.second]) >=
                   kShortestEdge * mOffset;
    }

    // Whether there was anything to split.
    bool splitWorst(double wanted) {
        std::map<Edge, double> gains; // by place
        for (const RefinedPart& part : mParts)
            for (const ProbedEdge& edge : part.edges)
                if (isSplittable(part, edge)) gains[edge.place] += edge.area * edge.squaredError;
        std::vector<std::pair<double, Edge>> worst;
        for (const auto& [place, gain] : gains) worst.emplace_back(gain, place);
        std::ranges::sort(worst, std::greater());
        const double share = std::min(kRoundShare * mError, mError - 0.9 * wanted);
        double sum = 0;
        std::vector<Edge> chosen;
        for (const auto& [gain, place] : worst) {
            if (sum >= share || !(gain > 0) || vertices() + chosen.size() >= kMostRefinedVertices) break;
            sum += gain;
            chosen.push_back(place);
        }
        std::ranges::sort(chosen);
        for (RefinedPart& part : mParts) split(part, chosen);
        return !chosen.empty();
    }

    void split(RefinedPart& part, const std::vector<Edge>& chosen) {
        std::vector<Edge> edges;
        for (const ProbedEdge& edge : part.edges)
            if (std::ranges::binary_search(chosen, edge.place)) {
                edges.push_back(edge.edge);
                part.answers.push_back(edge.middle);
            }
        splitEdges(part.part.mesh, edges);
        placeVertices(part);
    }

    ProbeLights mLights;
    CpuVisibility mVisibility;
    float mOffset;
    BakeObserver& mObserver;
    std::vector<RefinedPart> mParts;
    Places mPlaces;
    double mError = 0, mEnergy = 0; // over the surface
};

} // namespace

Refinement refine(std::vector<AssetPart>& parts, const Mesh& occluder, float visibilityOffset, double wanted,
                  BakeObserver& observer) {
    RELUME_CHECK(wanted > 0);
    return Refiner(parts, occluder, visibilityOffset, observer).run(wanted);
}

} // namespace relume
