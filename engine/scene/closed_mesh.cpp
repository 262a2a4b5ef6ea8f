#include "engine/scene/closed_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace relume {

namespace {

// Returns, per vertex, the first vertex in sorted order at the same position.
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

// A directed edge of a triangle between two welded vertices, of which `low` has the smaller index.
struct Side {
    uint32_t low, high, triangle;
    bool rises; // whether the triangle goes from low to high
    auto edge() const { return std::pair(low, high); }
};

std::vector<Side> sidesByEdge(const Mesh& mesh) {
    const std::vector<uint32_t> places = weld(mesh);
    std::vector<Side> sides;
    for (uint32_t t = 0; t < mesh.triangleCount(); t++)
        for (int c = 0; c < 3; c++) {
            const uint32_t from = places[mesh.triangles[t][c]], to = places[mesh.triangles[t][(c + 1) % 3]];
            if (from != to) sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
        }
    std::ranges::sort(sides, {}, &Side::edge);
    return sides;
}

// Returns six times the signed volume of the tetrahedron of a triangle and a point: positive where the point
// is behind the triangle.
double volumeBehind(const Mesh& mesh, uint32_t triangle, const glm::dvec3& point) {
    const uvec3 t = mesh.triangles[triangle];
    const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - point, b = glm::dvec3(mesh.positions[t.y]) - point,
                     c = glm::dvec3(mesh.positions[t.z]) - point;
    return glm::dot(a, glm::cross(b, c));
}

} // namespace

std::vector<bool> findClosedTriangles(const Mesh& mesh) {
    std::vector<Side> sides = sidesByEdge(mesh);
    const auto endOfRun = [&](auto first, auto same) {
        return std::find_if_not(first, sides.end(), [&](const Side& side) { return same(side, *first); });
    };
    // Triangles belong to one piece only across edges that exactly two share. Pieces that touch at a vertex,
    // or at an edge of more triangles, may be oriented differently.
    std::vector<uint32_t> pieces(mesh.triangleCount());
    std::iota(pieces.begin(), pieces.end(), 0u);
    for (auto first = sides.begin(); first != sides.end();) {
        const auto end = endOfRun(first, [](const Side& a, const Side& b) { return a.edge() == b.edge(); });
        if (end - first == 2) pieces[root(pieces, first->triangle)] = root(pieces, first[1].triangle);
        first = end;
    }
    std::vector<double> volumes(mesh.triangleCount(), 0);
    const glm::dvec3 middle(boundsOf(mesh).center());
    for (uint32_t t = 0; t < mesh.triangleCount(); t++)
        volumes[root(pieces, t)] += volumeBehind(mesh, t, middle);

    // A piece is closed if it uses each edge equally often in either direction.
    const auto edgeOfPiece = [&](const Side& side) {
        return std::tuple(side.low, side.high, root(pieces, side.triangle));
    };
    std::ranges::sort(sides, {}, edgeOfPiece);
    for (auto first = sides.begin(); first != sides.end();) {
        const auto end =
            endOfRun(first, [&](const Side& a, const Side& b) { return edgeOfPiece(a) == edgeOfPiece(b); });
        if (2 * std::count_if(first, end, [](const Side& side) { return side.rises; }) != end - first)
            volumes[root(pieces, first->triangle)] = 0;
        first = end;
    }
    std::vector<bool> isOfClosed(mesh.triangleCount());
    for (uint32_t t = 0; t < mesh.triangleCount(); t++) isOfClosed[t] = volumes[root(pieces, t)] > 0;
    return isOfClosed;
}

bool isClosed(const Mesh& mesh) {
    const std::vector<bool> isOfClosed = findClosedTriangles(mesh);
    for (uint32_t t = 0; t < mesh.triangleCount(); t++) {
        const uvec3 corners = mesh.triangles[t];
        const vec3 place = mesh.positions[corners.x];
        const bool isInOnePlace = mesh.positions[corners.y] == place && mesh.positions[corners.z] == place;
        if (!isOfClosed[t] && !isInOnePlace) return false;
    }
    return std::ranges::find(isOfClosed, true) != isOfClosed.end();
}

} // namespace relume
