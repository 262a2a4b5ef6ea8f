#include "precompute/bake/vertex_order.h"

#include "engine/base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

namespace relume {
namespace {

// Spreads the low ten bits of `value`, with two zeros after each.
uint32_t spread(uint32_t value) {
    value &= 0x3ff;
    value = (value | value << 16) & 0x030000ff;
    value = (value | value << 8) & 0x0300f00f;
    value = (value | value << 4) & 0x030c30c3;
    return (value | value << 2) & 0x09249249;
}

// Returns the Morton code of a point in the unit cube, ten bits per axis.
uint32_t mortonCode(vec3 point) {
    const vec3 cell = glm::clamp(point, vec3(0), vec3(1)) * 1023.0f + 0.5f;
    return spread(uint32_t(cell.x)) | spread(uint32_t(cell.y)) << 1 | spread(uint32_t(cell.z)) << 2;
}

struct Key {
    uint32_t position, octant, normal, index;

    bool operator<(const Key& other) const {
        return std::tie(position, octant, normal, index) <
               std::tie(other.position, other.octant, other.normal, other.index);
    }
};

std::vector<Key> sortedKeys(const Mesh& mesh) {
    const Bounds bounds = boundsOf(mesh);
    const vec3 extent = bounds.extent();
    // One scale for all axes keeps the curve's cells cubic.
    const float largest = std::max({extent.x, extent.y, extent.z});
    const float scale = largest > 0 ? 1 / largest : 0;
    std::vector<Key> keys(mesh.vertexCount());
    for (size_t i = 0; i < keys.size(); i++) {
        keys[i] = {mortonCode((mesh.positions[i] - bounds.low) * scale), 0, 0, uint32_t(i)};
        if (mesh.normals.empty()) continue;
        const vec3 n = mesh.normals[i];
        keys[i].octant = uint32_t(n.x < 0) | uint32_t(n.y < 0) << 1 | uint32_t(n.z < 0) << 2;
        keys[i].normal = mortonCode(0.5f * n + 0.5f);
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

// Rotates a triangle's indices so that the smallest is first.
uvec3 rotated(uvec3 t) {
    if (t.y < t.x && t.y < t.z) return {t.y, t.z, t.x};
    if (t.z < t.x && t.z < t.y) return {t.z, t.x, t.y};
    return t;
}

// Makes vertex order[i] vertex i, and renumbers and sorts the triangles.
void reorder(Mesh& mesh, std::span<const uint32_t> order) {
    std::vector<uint32_t> renumbered(order.size());
    for (size_t i = 0; i < order.size(); i++) renumbered[order[i]] = uint32_t(i);
    reorderVertices(mesh, order);
    for (uvec3& t : mesh.triangles) t = rotated({renumbered[t.x], renumbered[t.y], renumbered[t.z]});
    std::sort(mesh.triangles.begin(), mesh.triangles.end(), [](const uvec3& a, const uvec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
}

// Returns the side of the square of a cluster's share of the surface, or of the bounding box if the mesh has
// no area.
double clusterSide(const Mesh& mesh) {
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    const glm::dvec3 extent = glm::dvec3(boundsOf(mesh).high) - glm::dvec3(boundsOf(mesh).low);
    const double largest = std::max({extent.x, extent.y, extent.z});
    const double clusters = std::ceil(double(mesh.vertexCount()) / kOrderedVertices);
    const double side = std::sqrt((area > 0 ? area : largest * largest) / clusters);
    return side > 0 ? side : 1;
}

// Divides a mesh's vertices, which are in Morton order, into clusters.
class Bisection {
  public:
    explicit Bisection(const Mesh& mesh) : mFeatures(mesh.vertexCount()), mOrder(mesh.vertexCount()) {
        const double side = clusterSide(mesh);
        for (size_t i = 0; i < mFeatures.size(); i++) {
            const glm::dvec3 p = glm::dvec3(mesh.positions[i]) / side;
            const glm::dvec3 n =
                mesh.normals.empty() ? glm::dvec3(0) : kNormalWeight * glm::dvec3(mesh.normals[i]);
            mFeatures[i] = {p.x, p.y, p.z, n.x, n.y, n.z};
        }
        std::iota(mOrder.begin(), mOrder.end(), 0u);
        split(mOrder);
    }

    const std::vector<uint32_t>& order() const { return mOrder; }

  private:
    // Weight of normals relative to positions: a cluster across a sharp edge costs as much as one twice as
    // long.
    static constexpr double kNormalWeight = 2;

    size_t widestAxis(std::span<const uint32_t> vertices) const {
        std::array<double, 6> mean{}, spread{};
        for (const uint32_t vertex : vertices)
            for (size_t axis = 0; axis < 6; axis++) mean[axis] += mFeatures[vertex][axis];
        for (double& sum : mean) sum /= double(vertices.size());
        for (const uint32_t vertex : vertices)
            for (size_t axis = 0; axis < 6; axis++) {
                const double away = mFeatures[vertex][axis] - mean[axis];
                spread[axis] += away * away;
            }
        return size_t(std::max_element(spread.begin(), spread.end()) - spread.begin());
    }

    // `vertices` ascend; so do those of each cluster afterwards.
    void split(std::span<uint32_t> vertices) {
        const size_t clusters = (vertices.size() + kOrderedVertices - 1) / kOrderedVertices;
        if (clusters < 2) return;
        const size_t axis = widestAxis(vertices), cut = clusters / 2 * kOrderedVertices;
        const auto before = [&](uint32_t a, uint32_t b) {
            return std::tie(mFeatures[a][axis], a) < std::tie(mFeatures[b][axis], b);
        };
        std::vector<uint32_t> sorted(vertices.begin(), vertices.end());
        std::nth_element(sorted.begin(), sorted.begin() + ptrdiff_t(cut), sorted.end(), before);
        const uint32_t first = sorted[cut]; // of the upper half
        std::stable_partition(vertices.begin(), vertices.end(),
                              [&](uint32_t vertex) { return before(vertex, first); });
        split(vertices.first(cut));
        split(vertices.subspan(cut));
    }

    std::vector<std::array<double, 6>> mFeatures;
    std::vector<uint32_t> mOrder;
};

} // namespace

void orderVertices(Mesh& mesh) {
    RELUME_CHECK(mesh.normals.empty() || mesh.normals.size() == mesh.vertexCount());
    std::vector<uint32_t> order;
    for (const Key& key : sortedKeys(mesh)) order.push_back(key.index);
    reorder(mesh, order);
    reorder(mesh, Bisection(mesh).order());
}

} // namespace relume
