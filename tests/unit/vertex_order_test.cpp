#include "precompute/bake/vertex_order.h"

#include "engine/import/builtin_mesh.h"

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

TEST_CASE("vertex order: consecutive vertices are neighbors in space") {
    Mesh mesh = shuffled(makeKnot(12000), 3);
    const double before = meanStep(mesh);
    orderVertices(mesh);
    CHECK(meanStep(mesh) < 0.1 * before);
}

TEST_CASE("vertex order: clusters are compact, whatever the scale, and along a curve within") {
    // A strip of 8 × 512 cells: halved along its length down to 2 × 256 vertices' worth each.
    for (const float scale : {1e-6f, 1.0f, 1e9f}) {
        Mesh strip;
        for (uint32_t x = 0; x < 512; x++)
            for (uint32_t z = 0; z < 8; z++) strip.positions.push_back(scale * vec3(x, 0, z));
        strip.normals.assign(strip.positions.size(), vec3(0, 1, 0));
        for (uint32_t i = 0; i + 9 < strip.positions.size(); i++)
            strip.triangles.push_back({i, i + 1, i + 9});
        strip = shuffled(strip, 4);
        orderVertices(strip);
        for (size_t first = 0; first < strip.vertexCount(); first += kOrderedVertices)
            for (size_t i = first; i < first + kOrderedVertices; i++)
                CHECK(size_t(strip.positions[i].x / scale + 0.5f) / 32 == first / kOrderedVertices);
    }
}

TEST_CASE("vertex order: clusters do not reach around an edge") {
    // Two sheets back to back, closer than their vertices are.
    Mesh sheets;
    for (int side = 0; side < 2; side++)
        for (uint32_t i = 0; i < 1024; i++) {
            sheets.positions.push_back(vec3(i % 32, 0.01f * float(side), i / 32));
            sheets.normals.push_back(vec3(0, side ? 1 : -1, 0));
        }
    for (uint32_t i = 0; i + 33 < 1024; i++) sheets.triangles.push_back({i, i + 1, i + 33});
    sheets = shuffled(sheets, 5);
    orderVertices(sheets);
    for (size_t first = 0; first < 2048; first += kOrderedVertices)
        for (size_t i = first; i < first + kOrderedVertices; i++)
            CHECK(sheets.normals[i] == sheets.normals[first]);
}

TEST_CASE("vertex order: only the last cluster is short, points without extent keep their order") {
    Mesh mesh;
    for (int i = 0; i < 600; i++) mesh.positions.push_back(vec3(i < 100 ? 0 : 1, 0, 0));
    mesh.colors.resize(600);
    for (int i = 0; i < 600; i++) mesh.colors[size_t(i)] = vec4(float(i));
    orderVertices(mesh); // cut at 256: ties go by the order they came in
    for (int i = 0; i < 600; i++) CHECK(mesh.colors[size_t(i)] == vec4(float(i)));
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
