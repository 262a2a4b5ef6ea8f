#include "engine/scene/closed_mesh.h"

#include "engine/import/builtin_mesh.h"
#include "engine/render/numbered_triangles.h"

#include <algorithm>
#include <deque>
#include <doctest/doctest.h>

using namespace relume;

namespace {

Mesh turnedInsideOut(Mesh mesh) {
    for (uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

} // namespace

TEST_CASE("closed mesh: spheres are, with a seam of texture coordinates too, planes are not") {
    CHECK(isClosed(makeSphere(2)));
    CHECK(isClosed(makeSphere(2, true)));
    CHECK_FALSE(isClosed(makePlane(4, 3)));
    CHECK_FALSE(isClosed(Mesh{}));
}

TEST_CASE("closed mesh: a missing, a doubled or a turned triangle opens it") {
    Mesh mesh = makeSphere(2);
    mesh.triangles.pop_back();
    CHECK_FALSE(isClosed(mesh));
    mesh = makeSphere(2);
    mesh.triangles.push_back(mesh.triangles.back());
    CHECK_FALSE(isClosed(mesh));
    mesh = makeSphere(2);
    std::swap(mesh.triangles[5].x, mesh.triangles[5].y);
    CHECK_FALSE(isClosed(mesh));
}

TEST_CASE("closed mesh: every piece faces outwards") {
    Mesh mesh = makeSphere(2);
    CHECK_FALSE(isClosed(turnedInsideOut(mesh)));
    Mesh second = makeSphere(1);
    for (vec3& position : second.positions) position = 0.1f * position + vec3(7, 0, 0);
    Mesh both = mesh;
    append(both, second);
    CHECK(isClosed(both));
    append(mesh, turnedInsideOut(second)); // far smaller than the first, whose volume it does not undo
    CHECK_FALSE(isClosed(mesh));
}

TEST_CASE("closed mesh: pieces that touch at one place are apart") {
    const Mesh large = makeSphere(2);
    Mesh small = makeSphere(1);
    const auto easternmost = [](const Mesh& mesh, float side) {
        return *std::ranges::max_element(mesh.positions, {}, [&](vec3 p) { return side * p.x; });
    };
    for (vec3& position : small.positions) position *= 0.1f;
    const vec3 end = easternmost(small, -1), contact = easternmost(large, 1);
    for (vec3& position : small.positions) position = position == end ? contact : position - end + contact;
    Mesh outwards = large, inwards = large;
    append(outwards, small);
    append(inwards, turnedInsideOut(small));
    CHECK(isClosed(outwards));
    CHECK_FALSE(isClosed(inwards));
}

TEST_CASE("closed mesh: pieces that share an edge are apart, each closed or not") {
    Mesh tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    tetrahedron.triangles = {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}};
    REQUIRE(isClosed(tetrahedron));
    Mesh opposite = tetrahedron; // shares the edge from 0 to 1
    for (vec3& position : opposite.positions) position = {-position.x, -position.y, position.z};
    Mesh outwards = tetrahedron, inwards = tetrahedron, open = tetrahedron;
    append(outwards, opposite);
    append(inwards, turnedInsideOut(opposite));
    opposite.triangles.pop_back();
    append(open, opposite);
    CHECK(isClosed(outwards));
    const std::vector<bool> first{true, true, true, true, false, false, false, false};
    CHECK(findClosedTriangles(inwards) == first);
    CHECK(findClosedTriangles(open) == std::vector<bool>(first.begin(), first.end() - 1));
}

TEST_CASE("numbered triangles: each begins with the vertex of its number, and is what it was") {
    Mesh fan = makePlane(1, 1);
    fan.triangles.clear();
    for (int i = 0; i < 6; i++) fan.triangles.emplace_back(0, 1 + i % 2, 2 + i % 2);
    for (const Mesh& mesh : {makeSphere(2, true), makePlane(4, 3), fan, Mesh{}}) {
        const NumberedTriangles numbered = numberTriangles(mesh);
        REQUIRE_EQ(numbered.triangles.size(), mesh.triangleCount());
        CHECK_LE(numbered.positions.size(), mesh.triangleCount() + mesh.vertexCount());
        for (uint32_t t = 0; t < mesh.triangleCount(); t++) {
            const uvec3 found = numbered.triangles[t], expected = mesh.triangles[t];
            CHECK_EQ(found.x, t);
            bool same = false;
            for (int turn = 0; turn < 3; turn++) {
                bool all = true;
                for (int c = 0; c < 3; c++)
                    all &= numbered.positions[found[c]] == mesh.positions[expected[(c + turn) % 3]];
                same |= all;
            }
            CHECK(same);
        }
    }
}

TEST_CASE("numbered triangles: neighbors share vertices while devices hold them") {
    const Mesh mesh = makePlane(1, 100);
    const NumberedTriangles numbered = numberTriangles(mesh);
    // Vertices made where the last 32 are held; no order makes fewer than one a triangle.
    std::deque<uint32_t> held;
    size_t made = 0;
    for (const uvec3& triangle : numbered.triangles)
        for (int c = 0; c < 3; c++)
            if (std::ranges::find(held, triangle[c]) == held.end()) {
                made++;
                held.push_back(triangle[c]);
                if (held.size() > 32) held.pop_front();
            }
    CHECK_LT(made, mesh.triangleCount() * 21 / 20);
}
