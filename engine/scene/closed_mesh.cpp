#include "engine/scene/closed_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

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

uint32_t root(std::vector<uint32_t>& pieces, uint32_t place) {
    while (pieces[place] != place) place = pieces[place] = pieces[pieces[place]];
    return place;
}

} // namespace

bool isClosed(const Mesh& mesh) {
    const std::vector<uint32_t> places = weld(mesh);
    std::vector<uint32_t> pieces(mesh.vertexCount());
    std::iota(pieces.begin(), pieces.end(), 0u);
    std::vector<uint64_t> edges; // from one place to another, and those the other way
    std::vector<uint64_t> opposite;
    for (const uvec3& triangle : mesh.triangles)
        for (int c = 0; c < 3; c++) {
            const uint64_t from = places[triangle[c]], to = places[triangle[(c + 1) % 3]];
            if (from == to) continue;
            edges.push_back(from << 32 | to);
            opposite.push_back(to << 32 | from);
            pieces[root(pieces, uint32_t(from))] = root(pieces, uint32_t(to));
        }
    std::ranges::sort(edges);
    std::ranges::sort(opposite);
    if (edges.empty() || edges != opposite || std::ranges::adjacent_find(edges) != edges.end()) return false;
    std::vector<double> volumes(mesh.vertexCount(), 0);
    const glm::dvec3 middle(boundsOf(mesh).centre());
    for (const uvec3& triangle : mesh.triangles) {
        const glm::dvec3 a = glm::dvec3(mesh.positions[triangle.x]) - middle,
                         b = glm::dvec3(mesh.positions[triangle.y]) - middle,
                         c = glm::dvec3(mesh.positions[triangle.z]) - middle;
        volumes[root(pieces, places[triangle.x])] += glm::dot(a, glm::cross(b, c));
    }
    for (const uvec3& triangle : mesh.triangles)
        if (!(volumes[root(pieces, places[triangle.x])] > 0)) return false;
    return true;
}

} // namespace relume
