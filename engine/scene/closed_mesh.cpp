#include "engine/scene/closed_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace relume {

namespace {

// For every vertex, the first in order of those in its place.
std::vector<uint32_t> weld(const Mesh& mesh) {
    const auto less = [&](uint32_t a, uint32_t b) {
        const vec3 &p = mesh.positions[a], &q = mesh.positions[b];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    std::vector<uint32_t> order(mesh.vertexCount()), places(mesh.vertexCount());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, less);
    for (size_t i = 0; i < order.size(); i++)
        places[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? places[order[i - 1]] : order[i];
    return places;
}

uint32_t root(std::vector<uint32_t>& pieces, uint32_t triangle) {
    while (pieces[triangle] != triangle) triangle = pieces[triangle] = pieces[pieces[triangle]];
    return triangle;
}

// From one place to another, and the triangle it is of.
struct Edge {
    uint32_t from, to, triangle;
    auto ends() const { return std::pair(from, to); }
};

} // namespace

bool isClosed(const Mesh& mesh) {
    const std::vector<uint32_t> places = weld(mesh);
    std::vector<Edge> edges, opposite; // the latter the other way
    for (uint32_t t = 0; t < mesh.triangleCount(); t++)
        for (int c = 0; c < 3; c++) {
            const uint32_t from = places[mesh.triangles[t][c]], to = places[mesh.triangles[t][(c + 1) % 3]];
            if (from == to) continue;
            edges.push_back({from, to, t});
            opposite.push_back({to, from, t});
        }
    std::ranges::sort(edges, {}, &Edge::ends);
    std::ranges::sort(opposite, {}, &Edge::ends);
    if (edges.empty() || !std::ranges::equal(edges, opposite, {}, &Edge::ends, &Edge::ends) ||
        std::ranges::adjacent_find(edges, {}, &Edge::ends) != edges.end())
        return false;
    // Pieces meet at edges: those that touch at a place alone may face different ways.
    std::vector<uint32_t> pieces(mesh.triangleCount());
    std::iota(pieces.begin(), pieces.end(), 0u);
    for (size_t i = 0; i < edges.size(); i++)
        pieces[root(pieces, edges[i].triangle)] = root(pieces, opposite[i].triangle);
    std::vector<double> volumes(mesh.triangleCount(), 0);
    const glm::dvec3 middle(boundsOf(mesh).centre());
    for (uint32_t t = 0; t < mesh.triangleCount(); t++) {
        const uvec3 triangle = mesh.triangles[t];
        const glm::dvec3 a = glm::dvec3(mesh.positions[triangle.x]) - middle,
                         b = glm::dvec3(mesh.positions[triangle.y]) - middle,
                         c = glm::dvec3(mesh.positions[triangle.z]) - middle;
        volumes[root(pieces, t)] += glm::dot(a, glm::cross(b, c));
    }
    // Triangles of a single place have no edges and cannot be seen.
    return std::ranges::all_of(edges,
                               [&](const Edge& edge) { return volumes[root(pieces, edge.triangle)] > 0; });
}

} // namespace relume
