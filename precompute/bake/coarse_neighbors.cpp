#include "precompute/bake/coarse_neighbors.h"

#include "engine/base/check.h"
#include "engine/math/tangent_frame.h"
#include "precompute/bake/coarse_vertices.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr uint32_t kLeafPoints = 8;
constexpr size_t kMostNeighbors = 8;
// Weight of the distance from a vertex's tangent plane relative to that along it: what lies in another layer
// or around a corner has different visibility.
constexpr float kPlaneWeight = 3;

constexpr float kSlopeDamping = 0.05f;

float squared(float x) { return x * x; }

} // namespace

struct CoarseNeighbors::Search {
    struct Found {
        float squaredDistance;
        uint32_t coarse;
    };
    Point of;
    std::vector<Found> found; // ascending; the last is the first to be left out

    bool isFull() const { return found.size() > kMostNeighbors; }
    bool canBe(float squaredDistance) const {
        return !isFull() || squaredDistance < found.back().squaredDistance;
    }
    void offer(Found candidate) {
        if (!canBe(candidate.squaredDistance)) return;
        if (isFull()) found.pop_back();
        found.insert(std::ranges::upper_bound(found, candidate.squaredDistance, {}, &Found::squaredDistance),
                     candidate);
    }
};

CoarseNeighbors::Point CoarseNeighbors::pointOf(const Mesh& mesh, uint32_t vertex) const {
    const vec3 p = mesh.positions[vertex] * mScale, normal = mesh.normals[vertex];
    // Rows belong to light maps in the vertex's frame and change as it rotates.
    const vec3 n = normal * kNormalWeight, s = frameOf(mesh, vertex).s * kNormalWeight;
    return {{p.x, p.y, p.z, n.x, n.y, n.z, s.x, s.y, s.z}, normal, 0};
}

CoarseNeighbors::CoarseNeighbors(const Mesh& mesh, std::span<const uint32_t> coarse, float spacing)
    : mMesh(mesh), mScale(1 / spacing), mCoarse(coarse.begin(), coarse.end()) {
    RELUME_CHECK(!coarse.empty());
    for (uint32_t i = 0; i < coarse.size(); i++) {
        mPoints.push_back(pointOf(mesh, coarse[i]));
        mPoints.back().coarse = i;
    }
    build(0, uint32_t(mPoints.size()));
}

void CoarseNeighbors::build(uint32_t first, uint32_t end) {
    const size_t number = mNodes.size();
    const std::span points = std::span(mPoints).subspan(first, end - first);
    Node node{points[0].feature, points[0].feature, first, end, 0};
    size_t longest = 0;
    for (size_t axis = 0; axis < node.low.size(); axis++) {
        for (const Point& point : points) {
            node.low[axis] = std::min(node.low[axis], point.feature[axis]);
            node.high[axis] = std::max(node.high[axis], point.feature[axis]);
        }
        if (node.high[axis] - node.low[axis] > node.high[longest] - node.low[longest]) longest = axis;
    }
    mNodes.push_back(node);
    if (points.size() <= kLeafPoints) return;
    const uint32_t middle = first + (end - first) / 2;
    std::ranges::nth_element(points, points.begin() + (middle - first), {}, [&](const Point& point) {
        return std::pair(point.feature[longest], point.coarse);
    });
    build(first, middle);
    mNodes[number].right = uint32_t(mNodes.size());
    build(middle, end);
}

void CoarseNeighbors::search(uint32_t number, Search& search) const {
    const auto distanceTo = [&](const Node& node) {
        float sum = 0;
        for (size_t axis = 0; axis < node.low.size(); axis++) {
            const float at = search.of.feature[axis];
            sum += squared(at - std::clamp(at, node.low[axis], node.high[axis]));
        }
        return sum;
    };
    const Node& node = mNodes[number];
    if (node.right != 0) {
        const std::pair left{distanceTo(mNodes[number + 1]), number + 1};
        const std::pair right{distanceTo(mNodes[node.right]), node.right};
        for (const auto& [distance, half] : {std::min(left, right), std::max(left, right)})
            if (search.canBe(distance)) this->search(half, search);
        return;
    }
    for (const Point& point : std::span(mPoints).subspan(node.first, node.end - node.first)) {
        if (!(glm::dot(point.normal, search.of.normal) > kLeastNormalCosine)) continue;
        float distance = 0;
        for (size_t axis = 0; axis < point.feature.size(); axis++)
            distance += squared(point.feature[axis] - search.of.feature[axis]);
        const auto along = [&](const Point& plane) {
            float sum = 0;
            for (int axis = 0; axis < 3; axis++)
                sum += plane.normal[axis] * (point.feature[size_t(axis)] - search.of.feature[size_t(axis)]);
            return kPlaneWeight * sum;
        };
        distance += 0.5f * (squared(along(point)) + squared(along(search.of)));
        search.offer({distance, point.coarse});
    }
}

// Scales weights so that the neighbors' weighted mean, in the tangent plane, is the vertex, if it lies among
// them.
void CoarseNeighbors::balance(uint32_t vertex, std::vector<CoarseNeighbor>& neighbors) const {
    const TangentFrame frame = tangentFrame(mMesh.normals[vertex]);
    std::vector<vec2> places;
    vec2 middle(0);
    glm::mat2 spread(0);
    for (const CoarseNeighbor& neighbor : neighbors) {
        const vec3 away = mMesh.positions[mCoarse[neighbor.coarse]] - mMesh.positions[vertex];
        const vec2 place(frame.toLocal(away * mScale));
        middle += neighbor.weight * place;
        spread += neighbor.weight * glm::outerProduct(place, place);
        places.push_back(place);
    }
    // Damping keeps the slope small where collinear or coincident places leave it undetermined.
    spread += kSlopeDamping * (spread[0][0] + spread[1][1]) * glm::mat2(1);
    if (!(glm::determinant(spread) > 0)) return;
    const vec2 slope = glm::inverse(spread) * middle;
    for (size_t i = 0; i < places.size(); i++)
        neighbors[i].weight *= std::max(0.0f, 1 - glm::dot(slope, places[i]));
}

std::vector<CoarseNeighbor> CoarseNeighbors::of(uint32_t vertex) const {
    Search search{pointOf(mMesh, vertex), {}};
    this->search(0, search);
    RELUME_CHECK(!search.found.empty());
    const float nearest = std::sqrt(search.found.front().squaredDistance);
    if (nearest < 1e-6f || search.found.size() == 1) return {{search.found.front().coarse, 1}};
    // If there are no further neighbors, the last one is used, too.
    const float reach = std::sqrt(search.found.back().squaredDistance) * (search.isFull() ? 1 : 1.5f);
    std::vector<CoarseNeighbor> neighbors;
    for (const Search::Found& found : search.found) {
        const float distance = std::sqrt(found.squaredDistance);
        // Distances are relative to the nearest, to avoid overflow.
        const float weight = squared((reach - distance) / reach * (nearest / distance));
        if (weight > 0) neighbors.push_back({found.coarse, weight});
    }
    balance(vertex, neighbors);
    std::erase_if(neighbors, [](const CoarseNeighbor& neighbor) { return !(neighbor.weight > 0); });
    if (neighbors.empty()) return {{search.found.front().coarse, 1}};
    float sum = 0;
    for (const CoarseNeighbor& neighbor : neighbors) sum += neighbor.weight;
    for (CoarseNeighbor& neighbor : neighbors) neighbor.weight /= sum;
    return neighbors;
}

} // namespace relume
