#include "precompute/bake/vertex_order.h"

#include "engine/scene/builtin_mesh.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <numeric>
#include <random>

using namespace relume;

namespace {

// The same mesh with its vertices and triangles numbered another way.
Mesh shuffled(const Mesh& mesh, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<uint32_t> order(mesh.vertexCount()), place(mesh.vertexCount());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    Mesh result;
    for (uint32_t i = 0; i < order.size(); i++) {
        place[order[i]] = i;
        result.positions.push_back(mesh.positions[order[i]]);
        result.normals.push_back(mesh.normals[order[i]]);
    }
    for (const uvec3& t : mesh.triangles) result.triangles.push_back({place[t.y], place[t.z], place[t.x]});
    std::shuffle(result.triangles.begin(), result.triangles.end(), random);
    return result;
}

double meanStep(const Mesh& mesh) {
    double sum = 0;
    for (size_t i = 1; i < mesh.vertexCount(); i++)
        sum += glm::distance(mesh.positions[i], mesh.positions[i - 1]);
    return sum / double(mesh.vertexCount() - 1);
}

} // namespace

TEST_CASE("vertex order: the same mesh, whichever way it came numbered") {
    Mesh first = makeKnot(3000), second = shuffled(first, 1);
    orderVertices(first);
    orderVertices(second);
    CHECK(first.positions == second.positions);
    CHECK(first.normals == second.normals);
    CHECK(first.triangles == second.triangles);
}

TEST_CASE("vertex order: the surface stays, winding included") {
    const Mesh before = makeSphere(3);
    Mesh after = shuffled(before, 2);
    orderVertices(after);
    CHECK(after.triangleCount() == before.triangleCount());
    for (size_t i = 0; i < after.triangleCount(); i++) {
        const uvec3 t = after.triangles[i];
        CHECK(t.x < std::min(t.y, t.z));
        if (i > 0) CHECK(after.triangles[i - 1].x <= t.x);
        const vec3 a = after.positions[t.x], b = after.positions[t.y], c = after.positions[t.z];
        CHECK(glm::dot(glm::cross(b - a, c - a), a) > 0);
        CHECK(after.normals[t.x] == a);
    }
}

TEST_CASE("vertex order: neighbours along the curve are neighbours in space") {
    Mesh mesh = shuffled(makeKnot(12000), 3);
    const double before = meanStep(mesh);
    orderVertices(mesh);
    CHECK(meanStep(mesh) < 0.1 * before);
}

TEST_CASE("vertex order: the curve's first corners, and the normal where positions agree") {
    Mesh cube;
    cube.positions = {{1, 1, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}};
    cube.normals = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    cube.triangles = {{3, 2, 1}, {4, 5, 0}};
    cube.uvs = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
    cube.colors = {vec4(0), vec4(1), vec4(2), vec4(3), vec4(4), vec4(5)};
    orderVertices(cube);
    CHECK(cube.positions ==
          std::vector<vec3>{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
    CHECK(cube.normals[0] == vec3(1, 0, 0));
    CHECK(cube.normals[1] == vec3(-1, 0, 0));
    CHECK(cube.uvs == std::vector<vec2>{{4, 0}, {3, 0}, {2, 0}, {1, 0}, {5, 0}, {0, 0}});
    CHECK(cube.colors[4] == vec4(5));
    CHECK(cube.triangles == std::vector<uvec3>{{0, 4, 5}, {1, 2, 3}});
}
