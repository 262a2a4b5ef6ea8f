#include "engine/import/builtin_mesh.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace relume {

namespace {

// Adds two triangles per cell of a closed grid of `rows` × `columns` vertices in row order. Normals point
// along (next row) × (next column).
void joinClosedGrid(Mesh& mesh, int rows, int columns) {
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            const int nextRow = (row + 1) % rows, nextColumn = (column + 1) % columns;
            const uint32_t a = uint32_t(row * columns + column), b = uint32_t(nextRow * columns + column);
            const uint32_t c = uint32_t(nextRow * columns + nextColumn),
                           d = uint32_t(row * columns + nextColumn);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
}

// Adds 1 to periodic texture coordinates of a triangle so that none is more than half a period below the
// largest.
void closeUp(vec2 (&corners)[3]) {
    for (int axis = 0; axis < 2; axis++) {
        const float foremost = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
        for (vec2& corner : corners)
            if (corner[axis] < foremost - 0.5f) corner[axis] += 1;
    }
}

// Sets texture coordinates uvAt(triangle, corner) in [0, 1), and duplicates vertices along seams.
template <typename UvAt>
void unwrap(Mesh& mesh, const UvAt& uvAt) {
    std::map<std::tuple<uint32_t, float, float>, uint32_t> vertices;
    std::vector<uint32_t> order;
    std::vector<vec2> uvs;
    for (uvec3& triangle : mesh.triangles) {
        vec2 corners[3];
        for (int i = 0; i < 3; i++) corners[i] = uvAt(triangle, i);
        closeUp(corners);
        for (int i = 0; i < 3; i++) {
            const auto [entry, isNew] =
                vertices.try_emplace({triangle[i], corners[i].x, corners[i].y}, uint32_t(order.size()));
            if (isNew) {
                order.push_back(triangle[i]);
                uvs.push_back(corners[i]);
            }
            triangle[i] = entry->second;
        }
    }
    reorderVertices(mesh, order);
    mesh.uvs = std::move(uvs);
}

// Unwraps a closed grid: u follows the rows' indices, v opposes the columns'.
void unwrapGrid(Mesh& mesh, int rows, int columns) {
    unwrap(mesh, [=](const uvec3& triangle, int corner) {
        const int row = int(triangle[corner]) / columns, column = int(triangle[corner]) % columns;
        return vec2(float(row) / float(rows), float((columns - column) % columns) / float(columns));
    });
}

bool isPole(vec3 position) { return std::max(std::abs(position.x), std::abs(position.z)) < 1e-6f; }

// Returns latlong texture coordinates of a point on the unit sphere, u in [0, 1).
vec2 latlong(vec3 position) {
    const float u = 0.5f + std::atan2(position.x, position.z) / (2 * kPi);
    return {u < 1 ? u : 0.0f, std::acos(glm::clamp(position.y, -1.0f, 1.0f)) / kPi};
}

// At a pole longitude is undefined; uses the one midway between the triangle's other corners.
vec2 sphereUv(const Mesh& sphere, const uvec3& triangle, int corner) {
    const vec3 position = sphere.positions[triangle[corner]];
    if (!isPole(position)) return latlong(position);
    const vec3 middle =
        sphere.positions[triangle[(corner + 1) % 3]] + sphere.positions[triangle[(corner + 2) % 3]];
    return {latlong(middle).x, position.y > 0 ? 0 : 1};
}

// A point of the (2, 3) torus knot about the Y axis, with the frame of the tube's cross-section.
struct KnotPoint {
    vec3 center, tangent, outward; // outward: the torus's normal, perpendicular to the curve
};

constexpr float kKnotMajor = 2.0f, kKnotMinor = 1.0f, kKnotTube = 0.42f;

KnotPoint knotPoint(float t) {
    const float c2 = std::cos(2 * t), s2 = std::sin(2 * t), c3 = std::cos(3 * t), s3 = std::sin(3 * t);
    const float reach = kKnotMajor + kKnotMinor * c3;
    const vec3 tangent(-3 * kKnotMinor * s3 * c2 - 2 * reach * s2, 3 * kKnotMinor * c3,
                       -3 * kKnotMinor * s3 * s2 + 2 * reach * c2);
    return {{reach * c2, kKnotMinor * s3, reach * s2}, glm::normalize(tangent), {c3 * c2, s3, c3 * s2}};
}

} // namespace

Mesh makeSphere(int levels, bool hasUvs) {
    RELUME_CHECK(levels >= 0 && levels <= 10);
    const float g = 0.5f * (1 + std::sqrt(5.0f));
    Mesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (vec3& position : mesh.positions) position = glm::normalize(position);
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; level++) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [entry, isNew] =
                middles.try_emplace(std::minmax(a, b), uint32_t(mesh.positions.size()));
            if (isNew) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
            return entry->second;
        };
        std::vector<uvec3> finer;
        finer.reserve(mesh.triangleCount() * 4);
        for (const uvec3& t : mesh.triangles) {
            const uint32_t xy = middle(t.x, t.y), yz = middle(t.y, t.z), zx = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, xy, zx}, {t.y, yz, xy}, {t.z, zx, yz}, {xy, yz, zx}});
        }
        mesh.triangles = std::move(finer);
    }
    mesh.normals = mesh.positions;
    if (hasUvs)
        unwrap(mesh, [&](const uvec3& triangle, int corner) { return sphereUv(mesh, triangle, corner); });
    return mesh;
}

Mesh makeTorus(float majorRadius, float minorRadius, int around, int across, bool hasUvs) {
    RELUME_CHECK(majorRadius > minorRadius && minorRadius > 0 && around >= 3 && across >= 3);
    Mesh mesh;
    for (int i = 0; i < around; i++) {
        const float angle = 2 * kPi * float(i) / float(around);
        const vec3 outward(std::cos(angle), 0, -std::sin(angle));
        for (int j = 0; j < across; j++) {
            const float turn = 2 * kPi * float(j) / float(across);
            const vec3 normal = std::cos(turn) * outward + vec3(0, std::sin(turn), 0);
            mesh.positions.push_back(majorRadius * outward + minorRadius * normal);
            mesh.normals.push_back(glm::normalize(normal));
        }
    }
    joinClosedGrid(mesh, around, across);
    if (hasUvs) unwrapGrid(mesh, around, across);
    return mesh;
}

Mesh makeKnot(int vertices, bool hasUvs) {
    RELUME_CHECK(vertices >= 200 && vertices <= 100'000'000);
    float length = 0;
    const int steps = 600;
    for (int i = 0; i < steps; i++)
        length += glm::distance(knotPoint(2 * kPi * float(i) / steps).center,
                                knotPoint(2 * kPi * float(i + 1) / steps).center);
    // Choose cells as square as the two circumferences allow.
    const int across =
        std::max(5, int(std::lround(std::sqrt(float(vertices) * 2 * kPi * kKnotTube / length))));
    const int along = std::max(5, int(std::lround(double(vertices) / across)));
    const float scale = 1 / (kKnotMajor + kKnotMinor + kKnotTube);

    Mesh mesh;
    mesh.positions.reserve(size_t(along) * size_t(across));
    mesh.normals.reserve(size_t(along) * size_t(across));
    for (int i = 0; i < along; i++) {
        const KnotPoint point = knotPoint(2 * kPi * float(i) / float(along));
        const vec3 side = glm::cross(point.outward, point.tangent);
        for (int j = 0; j < across; j++) {
            const float turn = 2 * kPi * float(j) / float(across);
            const vec3 normal = glm::normalize(std::cos(turn) * point.outward + std::sin(turn) * side);
            mesh.positions.push_back(scale * (point.center + kKnotTube * normal));
            mesh.normals.push_back(normal);
        }
    }
    joinClosedGrid(mesh, along, across);
    if (hasUvs) unwrapGrid(mesh, along, across);
    return mesh;
}

Mesh makePlane(float size, int quads, bool hasUvs) {
    RELUME_CHECK(size > 0 && quads >= 1 && quads <= 10'000);
    Mesh mesh;
    const int side = quads + 1;
    for (int row = 0; row < side; row++)
        for (int column = 0; column < side; column++) {
            const vec2 uv(float(column) / float(quads), float(row) / float(quads));
            mesh.positions.push_back(size * vec3(uv.x - 0.5f, 0, uv.y - 0.5f));
            if (hasUvs) mesh.uvs.push_back(uv);
        }
    mesh.normals.assign(mesh.positions.size(), vec3(0, 1, 0));
    for (int row = 0; row < quads; row++)
        for (int column = 0; column < quads; column++) {
            const uint32_t a = uint32_t(row * side + column), below = a + uint32_t(side);
            mesh.triangles.push_back({a, below, below + 1});
            mesh.triangles.push_back({a, below + 1, a + 1});
        }
    return mesh;
}

Mesh makeGround(const Bounds& object, const GroundOptions& options) {
    const vec3 extent = object.extent();
    const float largest = std::max({extent.x, extent.y, extent.z});
    RELUME_CHECK(largest > 0 && options.extent > 0);
    Mesh ground = makePlane(options.extent * largest, options.tessellation);
    const vec3 center(object.center().x, object.low.y, object.center().z);
    for (vec3& position : ground.positions) position += center;
    return ground;
}

} // namespace relume
