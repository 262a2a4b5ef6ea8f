#include "engine/import/builtin_mesh.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <map>

using namespace relume;

namespace {

// Signed volume by the divergence theorem: positive when triangles are counter-clockwise from outside.
double volume(const Mesh& mesh) {
    double sum = 0;
    for (const uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        sum += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return sum;
}

// Whether every edge is met by two triangles that run along it in opposite directions.
bool isEdgeManifold(const Mesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> balance;
    for (const uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; i++) {
            const uint32_t a = t[i], b = t[(i + 1) % 3];
            if (++balance[{a, b}] > 1) return false;
        }
    for (const auto& [edge, count] : balance)
        if (!balance.contains({edge.second, edge.first})) return false;
    return true;
}

// Smallest cosine between a triangle's normal and those of its corners.
float worstAgreement(const Mesh& mesh) {
    float worst = 1;
    for (const uvec3& t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
        for (int i = 0; i < 3; i++) worst = std::min(worst, glm::dot(normal, mesh.normals[t[i]]));
    }
    return worst;
}

} // namespace

TEST_CASE("built-in sphere: counts, radius, volume") {
    for (int levels = 0; levels <= 5; levels++)
        CHECK(makeSphere(levels).vertexCount() == size_t(10 << (2 * levels)) + 2);
    const Mesh sphere = makeSphere(5);
    CHECK(isEdgeManifold(sphere));
    CHECK(volume(sphere) == doctest::Approx(4 * kPi / 3).epsilon(2e-3));
    CHECK(worstAgreement(sphere) > 0.999f);
    for (const vec3& position : sphere.positions)
        CHECK(glm::length(position) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("built-in torus: closed, 2π²Rr² in volume") {
    const Mesh torus = makeTorus(0.7f, 0.3f, 160, 64);
    CHECK(torus.vertexCount() == 160 * 64);
    CHECK(isEdgeManifold(torus));
    CHECK(volume(torus) == doctest::Approx(2 * kPi * kPi * 0.7 * 0.3 * 0.3).epsilon(3e-3));
    CHECK(worstAgreement(torus) > 0.99f);
}

TEST_CASE("built-in knot: a closed tube of the size asked for, that nowhere cuts itself") {
    for (int vertices : {500, 3000, 12000}) {
        const Mesh knot = makeKnot(vertices);
        CHECK(std::abs(double(knot.vertexCount()) - vertices) < 0.05 * vertices);
        CHECK(isEdgeManifold(knot));
        CHECK(volume(knot) > 0);
    }
    const Mesh knot = makeKnot();
    CHECK(worstAgreement(knot) > 0.97f);
    CHECK(boundsOf(knot).high.x <= 1.0001f);
    CHECK(boundsOf(knot).high.x > 0.9f);
    // Pappus: the volume of a tube is its length times its cross-section, if it does not overlap. Points off
    // the surface along the normal stay outside of all other parts of it.
    float nearest = 1;
    for (size_t i = 0; i < knot.vertexCount(); i += 7)
        for (size_t j = 0; j < knot.vertexCount(); j += 5) {
            const vec3 apart = knot.positions[j] - knot.positions[i];
            if (glm::dot(knot.normals[i], knot.normals[j]) < -0.5f && glm::dot(apart, knot.normals[i]) > 0)
                nearest = std::min(nearest, glm::length(apart));
        }
    CHECK(nearest > 0.05f);
    CHECK(nearest < 0.3f); // near enough to shadow itself
}

TEST_CASE("built-in plane: flat, up, exact size") {
    const Mesh plane = makePlane(3, 4);
    CHECK(plane.vertexCount() == 25);
    CHECK(plane.triangleCount() == 32);
    CHECK(boundsOf(plane).extent() == vec3(3, 0, 3));
    CHECK(worstAgreement(plane) == doctest::Approx(1));
}

TEST_CASE("built-in meshes: texture coordinates cover the image once, unmirrored, seams closed") {
    for (const Mesh& mesh : {makeSphere(4, true), makeTorus(0.7f, 0.3f, 40, 16, true), makeKnot(3000, true),
                             makePlane(2, 10, true)}) {
        REQUIRE(mesh.uvs.size() == mesh.vertexCount());
        REQUIRE(mesh.normals.size() == mesh.vertexCount());
        double area = 0;
        for (const uvec3& t : mesh.triangles) {
            const vec2 a = mesh.uvs[t.x], ab = mesh.uvs[t.y] - a, ac = mesh.uvs[t.z] - a;
            CHECK(std::max({std::abs(ab.x), std::abs(ab.y), std::abs(ac.x), std::abs(ac.y)}) < 0.5f);
            area -= 0.5 * (ab.x * ac.y - ab.y * ac.x); // v goes down
        }
        CHECK(area == doctest::Approx(1).epsilon(0.02));
    }
    const Mesh sphere = makeSphere(3, true);
    CHECK(sphere.vertexCount() < makeSphere(3).vertexCount() + 50);
    for (size_t i = 0; i < sphere.vertexCount(); i++)
        if (glm::distance(sphere.positions[i], vec3(0, 0, 1)) < 1e-3f)
            CHECK(glm::distance(sphere.uvs[i], vec2(0.5f)) < 1e-3f);
    CHECK(makeSphere(3).uvs.empty());
}

TEST_CASE("mesh: normals made from faces agree with a sphere's own") {
    Mesh sphere = makeSphere(4);
    const std::vector<vec3> exact = sphere.normals;
    makeNormals(sphere);
    float worst = 1;
    for (size_t i = 0; i < exact.size(); i++) worst = std::min(worst, glm::dot(exact[i], sphere.normals[i]));
    CHECK(worst > 0.9999f);
}

TEST_CASE("mesh: a cube's corner normals do not depend on how its sides are cut") {
    // Weighted by angle, each of the three sides counts once, whether one or two triangles meet in the
    // corner.
    Mesh corner;
    corner.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
    corner.triangles = {{0, 4, 1}, {0, 2, 4}, {0, 1, 3}, {0, 3, 2}};
    makeNormals(corner);
    CHECK(glm::distance(corner.normals[0], -glm::normalize(vec3(1))) < 1e-6f);
}

TEST_CASE("mesh: appending keeps normals only when both have them") {
    Mesh both = makeSphere(0);
    append(both, makePlane(1, 1));
    CHECK(both.vertexCount() == 16);
    CHECK(both.normals.size() == 16);
    CHECK(both.triangles.back() == makePlane(1, 1).triangles.back() + uvec3(12));
    Mesh bare = makePlane(1, 1);
    bare.normals.clear();
    append(both, bare);
    CHECK(both.vertexCount() == 20);
    CHECK(both.normals.empty());
    Mesh painted = makePlane(1, 1, true);
    append(painted, makePlane(1, 2, true));
    CHECK(painted.uvs.size() == 13);
    append(painted, makePlane(1, 1));
    CHECK(painted.uvs.empty());
}
