#include "precompute/visibility/occluder.h"

#include "engine/import/builtin_mesh.h"
#include "precompute/visibility/flat_mesh.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace relume;

namespace {

Part part(Mesh mesh) { return {"part", std::move(mesh), "clay", "", ""}; }

double area(const Mesh& mesh) {
    double sum = 0;
    for (const uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return sum;
}

} // namespace

TEST_CASE("flat mesh: a ground becomes two triangles, however it lies") {
    for (float degrees : {0.0f, 33.0f, 90.0f}) {
        Mesh ground = makePlane(3, 148);
        const mat3 turn(glm::rotate(mat4(1), glm::radians(degrees), glm::normalize(vec3(1, 2, 3))));
        for (vec3& position : ground.positions) position = turn * position + vec3(5, -7, 11);
        const std::optional<Mesh> reduced = reduceFlat(ground);
        REQUIRE(reduced.has_value());
        CHECK(reduced->triangleCount() == 2);
        CHECK(area(*reduced) == doctest::Approx(9).epsilon(1e-5));
        const vec3 a = reduced->positions[0], b = reduced->positions[1], c = reduced->positions[2];
        CHECK(glm::distance(glm::normalize(glm::cross(b - a, c - a)), turn * vec3(0, 1, 0)) < 1e-4f);
    }
}

TEST_CASE("flat mesh: nothing that has a hole, a bay, a bump or two sides") {
    Mesh hole = makePlane(1, 8);
    hole.triangles.erase(hole.triangles.begin() + 60);
    CHECK(!reduceFlat(hole));
    Mesh bay = makePlane(1, 8);
    bay.triangles.pop_back();
    bay.triangles.pop_back();
    CHECK(!reduceFlat(bay));
    Mesh bump = makePlane(1, 8);
    bump.positions[40].y = 1e-3f;
    CHECK(!reduceFlat(bump));
    Mesh sides = makePlane(1, 2), other = makePlane(1, 2);
    for (uvec3& t : other.triangles) std::swap(t.y, t.z);
    append(sides, other);
    CHECK(!reduceFlat(sides));
    CHECK(!reduceFlat(makeSphere(2)));
}

TEST_CASE("occluder: budget 0 keeps every triangle but the ground's") {
    Scene scene{{part(makeSphere(3))}};
    addGround(scene, {148, 3});
    const Occluder occluder = makeOccluder(scene, 0);
    CHECK(occluder.mesh.triangleCount() == 1280 + 2);
    CHECK(occluder.error == 0);
    CHECK(visibilityOffset(occluder, boundsOf(scene)) == doctest::Approx(1e-4f * boundsOf(scene).radius()));
}

TEST_CASE("occluder: the budget is shared by size, the error stays honest") {
    Scene scene{{part(makeSphere(5)), part(makeSphere(4))}};
    for (vec3& position : scene.parts[1].mesh.positions) position = 10.0f * position + vec3(30, 0, 0);
    addGround(scene, {148, 3});
    const Occluder occluder = makeOccluder(scene, 5002);
    CHECK(occluder.mesh.triangleCount() <= 5002);
    CHECK(occluder.mesh.triangleCount() > 4900);
    size_t small = 0;
    float worst = 0;
    for (const uvec3& t : occluder.mesh.triangles) {
        const vec3 center =
            (occluder.mesh.positions[t.x] + occluder.mesh.positions[t.y] + occluder.mesh.positions[t.z]) /
            3.0f;
        if (glm::length(center) < 1.5f && ++small)
            worst = std::max(worst, 1 - glm::length(center));
        else if (glm::distance(center, vec3(30, 0, 0)) < 10.5f && center.y > -9.9f)
            worst = std::max(worst, 10 - glm::distance(center, vec3(30, 0, 0)));
    }
    CHECK(double(small) == doctest::Approx(4000).epsilon(0.02)); // 20480 of 25600 triangles
    CHECK(occluder.error > 0);
    CHECK(worst < 3 * occluder.error);
    CHECK(visibilityOffset(occluder, boundsOf(scene)) >= occluder.error);
    const Occluder again = makeOccluder(scene, 5002);
    CHECK(again.mesh.positions == occluder.mesh.positions);
    CHECK(again.mesh.triangles == occluder.mesh.triangles);
}

TEST_CASE("occluder: creases of the normals do not tear") {
    // A faceted sphere: every triangle has three vertices of its own.
    const Mesh smooth = makeSphere(4);
    Mesh faceted;
    for (const uvec3& t : smooth.triangles) {
        const uint32_t first = uint32_t(faceted.vertexCount());
        for (int i = 0; i < 3; i++) faceted.positions.push_back(smooth.positions[t[i]]);
        faceted.triangles.push_back({first, first + 1, first + 2});
    }
    makeNormals(faceted);
    const Occluder occluder = makeOccluder({{part(faceted)}}, 1000);
    CHECK(occluder.mesh.triangleCount() <= 1000);
    CHECK(occluder.mesh.triangleCount() > 900);
    // Euler: closed and in one piece.
    CHECK(occluder.mesh.vertexCount() == occluder.mesh.triangleCount() / 2 + 2);
}
