// A part under refinement, with probes of its transport at vertices and edge midpoints.
#pragma once

#include "precompute/refine/edge_split.h"
#include "precompute/refine/transport_probe.h"

#include <functional>

namespace relume {

// The interpolation error at an edge's midpoint. Squares are of random projections (transport_probe.h).
struct ProbedEdge {
    Edge edge;
    double area = 0; // a third of the area of its triangles, which the midpoints of their edges represent
    double squaredError = 0; // of the mean of the ends' projections against the midpoint's
    double squaredResponse = 0;
    uint32_t middle; // number of its probed point
};

class RefinedPart {
  public:
    // Keeps references to `part`, whose sets are factored, `visibility` and `lights`.
    RefinedPart(AssetPart& part, const CpuVisibility& visibility, const ProbeLights& lights,
                float visibilityOffset);

    const Mesh& mesh() const { return mPart.mesh; }
    const std::vector<ProbedEdge>& edges() const { return mEdges; } // sorted; valid after probe()

    // Probes all vertices and edge midpoints that were not probed before, on all threads. Calls report(done,
    // count) every few hundred of them, which may throw.
    void probe(const std::function<void(size_t, size_t)>& report);

    // Splits some of edges(), given by index; probe() then finds the new edges.
    void split(std::span<const uint32_t> numbers);

  private:
    // Probes points and appends their responses.
    void probe(std::span<const EdgeMiddle> points, const std::function<void(size_t, size_t)>& report);
    void findEdges();

    AssetPart& mPart;
    TransportProbe mProbe;
    float mOffset;
    std::vector<ProbedPoint> mPoints;
    std::vector<uint32_t> mOfVertices; // per vertex: its index in mPoints
    std::vector<ProbedEdge> mEdges;
};

} // namespace relume
