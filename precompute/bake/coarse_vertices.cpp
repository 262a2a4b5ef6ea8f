#include "precompute/bake/coarse_vertices.h"

#include "engine/base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace relume {

float vertexSpacing(const Mesh& mesh, size_t count) {
    double area = 0;
    for (const uvec3& t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x];
        area += 0.5 * double(glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a)));
    }
    const auto spacing = float(std::sqrt(area / double(count)));
    return spacing > 0 ? spacing : 1;
}

namespace {

// Position and normal, in units of the spacing.
using Feature = std::array<float, 6>;

class Grouping {
  public:
    Grouping(const Mesh& mesh, float spacing) : mMesh(mesh), mScale(1 / spacing), mOrder(mesh.vertexCount()) {
        std::iota(mOrder.begin(), mOrder.end(), 0u);
    }

    std::vector<uint32_t> middles(size_t count) {
        split(mOrder, count);
        std::ranges::sort(mMiddles);
        return std::move(mMiddles);
    }

  private:
    Feature feature(uint32_t vertex) const {
        const vec3 p = mMesh.positions[vertex] * mScale, n = mMesh.normals[vertex] * kNormalWeight;
        return {p.x, p.y, p.z, n.x, n.y, n.z};
    }

    size_t longestAxis(std::span<const uint32_t> group) const {
        Feature low = feature(group.front()), high = low, extent{};
        for (const uint32_t vertex : group) {
            const Feature at = feature(vertex);
            for (size_t axis = 0; axis < at.size(); axis++) {
                low[axis] = std::min(low[axis], at[axis]);
                high[axis] = std::max(high[axis], at[axis]);
            }
        }
        for (size_t axis = 0; axis < extent.size(); axis++) extent[axis] = high[axis] - low[axis];
        return size_t(std::ranges::max_element(extent) - extent.begin());
    }

    uint32_t middleOf(std::span<const uint32_t> group) const {
        std::array<double, 6> mean{};
        for (const uint32_t vertex : group)
            for (size_t axis = 0; axis < mean.size(); axis++)
                mean[axis] += double(feature(vertex)[axis]) / double(group.size());
        const auto distance = [&](uint32_t vertex) {
            double sum = 0;
            for (size_t axis = 0; axis < mean.size(); axis++)
                sum += std::pow(double(feature(vertex)[axis]) - mean[axis], 2);
            return std::pair(sum, vertex);
        };
        return std::ranges::min(group, {}, distance);
    }

    void split(std::span<uint32_t> group, size_t count) {
        if (count == 1) {
            mMiddles.push_back(middleOf(group));
            return;
        }
        const size_t axis = longestAxis(group), left = count / 2, middle = group.size() * left / count;
        std::ranges::nth_element(group, group.begin() + std::ptrdiff_t(middle), {},
                                 [&](uint32_t vertex) { return std::pair(feature(vertex)[axis], vertex); });
        split(group.first(middle), left);
        split(group.subspan(middle), count - left);
    }

    const Mesh& mMesh;
    float mScale;
    std::vector<uint32_t> mOrder, mMiddles;
};

} // namespace

std::vector<uint32_t> coarseVertices(const Mesh& mesh, size_t count, float spacing) {
    RELUME_CHECK(count >= 1 && count <= mesh.vertexCount());
    std::vector<uint32_t> coarse = Grouping(mesh, spacing).middles(count);
    // Few vertices are added, since the normals of added ones differ from each other by more than the cosine
    // allows.
    const std::vector<vec3>& normals = mesh.normals;
    size_t like = 0; // starts with that of the previous vertex, most often the same
    for (uint32_t vertex = 0; vertex < mesh.vertexCount(); vertex++) {
        const auto isLike = [&](uint32_t other) {
            return glm::dot(normals[vertex], normals[other]) > kLeastNormalCosine;
        };
        if (isLike(coarse[like])) continue;
        const auto found = std::ranges::find_if(coarse, isLike);
        like = size_t(found - coarse.begin());
        if (found == coarse.end()) coarse.push_back(vertex);
    }
    std::ranges::sort(coarse);
    return coarse;
}

} // namespace relume
