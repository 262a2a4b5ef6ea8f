// A part that is refined: what is known of its transport at vertices and between them.
#pragma once

#include "precompute/refine/edge_split.h"
#include "precompute/refine/transport_probe.h"

#include <functional>

namespace relume {

// What interpolation makes of an edge's middle. Squares are of answers (transport_probe.h).
struct ProbedEdge {
    Edge edge;
    double area = 0;         // a third of that of its triangles: the middles of edges stand for all of these
    double squaredError = 0; // mean of the ends' answers against the middle's own
    double squaredAnswer = 0;
    uint32_t middle; // its answers' number
};

class RefinedPart {
  public:
    // Keeps references to all but the offset. The part's sets are factored.
    RefinedPart(AssetPart& part, const CpuVisibility& visibility, const ProbeLights& lights,
                float visibilityOffset);

    const Mesh& mesh() const { return mPart.mesh; }
    const std::vector<ProbedEdge>& edges() const { return mEdges; } // sorted, after probe()

    // Probes vertices and middles of edges, each once in its life, on all threads. `report(done, count)` is
    // called every few hundred of them and may throw.
    void probe(const std::function<void(size_t, size_t)>& report);

    // Splits some of edges(), by number; probe() then finds the new ones.
    void split(std::span<const uint32_t> numbers);

  private:
    // Appends answers of the points.
    void probe(std::span<const EdgeMiddle> points, const std::function<void(size_t, size_t)>& report);
    void findEdges();

    AssetPart& mPart;
    TransportProbe mProbe;
    float mOffset;
    std::vector<ProbeAnswers> mAnswers;
    std::vector<uint32_t> mOfVertices; // the number of a vertex's answers
    std::vector<ProbedEdge> mEdges;
};

} // namespace relume
