#include "precompute/refine/refined_part.h"

#include "engine/base/check.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr uint32_t kUnknown = std::numeric_limits<uint32_t>::max();
constexpr size_t kProbesAtOnce = 512;

double squaredLength(const ProbeResponses& responses) {
    double sum = 0;
    for (const float response : responses) sum += double(response) * double(response);
    return sum;
}

double squaredError(const ProbeResponses& first, const ProbeResponses& second, const ProbeResponses& middle) {
    double sum = 0;
    for (size_t i = 0; i < middle.size(); i++) {
        const double error = 0.5 * (double(first[i]) + double(second[i])) - double(middle[i]);
        sum += error * error;
    }
    return sum;
}

double areaOf(const Mesh& mesh, uvec3 triangle) {
    const vec3 a = mesh.positions[triangle.x];
    return 0.5 *
           double(glm::length(glm::cross(mesh.positions[triangle.y] - a, mesh.positions[triangle.z] - a)));
}

} // namespace

RefinedPart::RefinedPart(AssetPart& part, const CpuVisibility& visibility, const ProbeLights& lights,
                         float visibilityOffset)
    : mPart(part), mProbe(part, visibility, lights), mOffset(visibilityOffset) {
    findEdges();
}

void RefinedPart::probe(const std::function<void(size_t, size_t)>& report) {
    const Mesh& mesh = mPart.mesh;
    std::vector<EdgeMiddle> points;
    if (mOfVertices.empty()) { // later vertices were probed as middles of edges
        for (size_t i = 0; i < mesh.vertexCount(); i++)
            points.push_back(
                {mesh.positions[i], mesh.normals[i], mesh.tangents.empty() ? vec3(0) : mesh.tangents[i]});
        mOfVertices.resize(mesh.vertexCount());
        std::iota(mOfVertices.begin(), mOfVertices.end(), 0u);
    }
    auto number = uint32_t(mResponses.size() + points.size());
    std::vector<ProbedEdge*> fresh;
    for (ProbedEdge& edge : mEdges) {
        if (edge.middle != kUnknown) continue;
        edge.middle = number++;
        points.push_back(middleOf(mesh, edge.edge));
        fresh.push_back(&edge);
    }
    probe(points, report);
    for (ProbedEdge* edge : fresh) {
        const ProbeResponses& middle = mResponses[edge->middle];
        edge->squaredResponse = squaredLength(middle);
        edge->squaredError = squaredError(mResponses[mOfVertices[edge->edge.first]],
                                          mResponses[mOfVertices[edge->edge.second]], middle);
    }
}

void RefinedPart::probe(std::span<const EdgeMiddle> points,
                        const std::function<void(size_t, size_t)>& report) {
    tbb::enumerable_thread_specific<TransportProbe::Workspace> workspaces(
        [this] { return mProbe.makeWorkspace(); });
    const size_t start = mResponses.size();
    mResponses.resize(start + points.size());
    for (size_t first = 0; first < points.size(); first += kProbesAtOnce) {
        report(first, points.size());
        tbb::parallel_for(first, std::min(points.size(), first + kProbesAtOnce), [&](size_t i) {
            const vec3 lifted = points[i].position + mOffset * points[i].normal;
            mResponses[start + i] = mProbe.responses(lifted, points[i].frame(), workspaces.local());
        });
    }
    report(points.size(), points.size());
}

// Finds the edges. Those that existed before keep their data; an edge only disappears by being split.
void RefinedPart::findEdges() {
    std::vector<std::pair<Edge, double>> sides;
    for (const uvec3& t : mPart.mesh.triangles) {
        const double third = areaOf(mPart.mesh, t) / 3;
        for (const Edge edge : {Edge(t.x, t.y), Edge(t.y, t.z), Edge(t.z, t.x)})
            sides.emplace_back(edge, third);
    }
    std::ranges::sort(sides);
    std::vector<ProbedEdge> edges;
    auto known = mEdges.begin();
    for (const auto& [edge, third] : sides) {
        if (edges.empty() || edges.back().edge != edge) {
            while (known != mEdges.end() && known->edge < edge) known++;
            const bool isKnown = known != mEdges.end() && known->edge == edge;
            edges.push_back(isKnown ? *known : ProbedEdge{.edge = edge, .middle = kUnknown});
            edges.back().area = 0;
        }
        edges.back().area += third;
    }
    mEdges = std::move(edges);
}

void RefinedPart::split(std::span<const uint32_t> numbers) {
    std::vector<Edge> edges;
    for (const uint32_t number : numbers) {
        RELUME_CHECK(mEdges[number].middle != kUnknown);
        edges.push_back(mEdges[number].edge);
        mOfVertices.push_back(mEdges[number].middle);
    }
    splitEdges(mPart.mesh, edges);
    findEdges();
}

} // namespace relume
