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

// Returns the share of a point's unshadowed transport that is seen, by least squares.
double litShare(const ProbedPoint& point) {
    double both = 0, all = 0;
    for (size_t i = 0; i < point.seen.size(); i++) {
        const double unshadowed = double(point.seen[i]) + double(point.blocked[i]);
        both += double(point.seen[i]) * unshadowed;
        all += unshadowed * unshadowed;
    }
    return all > 0 ? std::clamp(both / all, 0.0, 1.0) : 0;
}

// Returns the squared error of the mean of two points' transport, less `share` of the error of their
// unshadowed transport: interpolation changes both alike where light is neither found nor lost.
double squaredError(const ProbedPoint& first, const ProbedPoint& second, const ProbedPoint& middle,
                    double share) {
    double sum = 0;
    for (size_t i = 0; i < middle.seen.size(); i++) {
        const auto away = [i, &first, &second, &middle](ProbeResponses ProbedPoint::*of) {
            return 0.5 * (double((first.*of)[i]) + double((second.*of)[i])) - double((middle.*of)[i]);
        };
        const double error = (1 - share) * away(&ProbedPoint::seen) - share * away(&ProbedPoint::blocked);
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
    auto number = uint32_t(mPoints.size() + points.size());
    std::vector<ProbedEdge*> fresh;
    for (ProbedEdge& edge : mEdges) {
        if (edge.middle != kUnknown) continue;
        edge.middle = number++;
        points.push_back(middleOf(mesh, edge.edge));
        fresh.push_back(&edge);
    }
    probe(points, report);
    for (ProbedEdge* edge : fresh) {
        const ProbedPoint& middle = mPoints[edge->middle];
        edge->squaredResponse = squaredLength(middle.seen);
        edge->squaredError =
            squaredError(mPoints[mOfVertices[edge->edge.first]], mPoints[mOfVertices[edge->edge.second]],
                         middle, mProbe.hasResiduals() ? litShare(middle) : 0);
    }
}

void RefinedPart::probe(std::span<const EdgeMiddle> points,
                        const std::function<void(size_t, size_t)>& report) {
    tbb::enumerable_thread_specific<TransportProbe::Workspace> workspaces(
        [this] { return mProbe.makeWorkspace(); });
    const size_t start = mPoints.size();
    mPoints.resize(start + points.size());
    for (size_t first = 0; first < points.size(); first += kProbesAtOnce) {
        report(first, points.size());
        tbb::parallel_for(first, std::min(points.size(), first + kProbesAtOnce), [&](size_t i) {
            const vec3 lifted = points[i].position + mOffset * points[i].normal;
            mPoints[start + i] = mProbe.probe(lifted, points[i].frame(), workspaces.local());
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
