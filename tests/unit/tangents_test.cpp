// Tests tangent fields: what they follow, and where they are singular.
#include "precompute/bake/tangents.h"

#include "engine/import/builtin_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

// The angle from one frame's s to the other's, carried along with the normal; in (-π, π].
float turnBetween(const TangentFrame& from, const TangentFrame& to) {
    const vec3 s = from.s - glm::dot(to.n, from.s) / (1 + glm::dot(from.n, to.n)) * (from.n + to.n);
    return std::atan2(glm::dot(s, to.t), glm::dot(s, to.s));
}

// The largest turn of neighbors' tangents against each other, over edges whose ends are both in a region.
template <typename Region>
float largestTurn(const Mesh& mesh, Region&& contains) {
    float largest = 0;
    for (const uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; i++) {
            const uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
            if (contains(mesh.positions[a]) && contains(mesh.positions[b]))
                largest = std::max(largest, std::abs(turnBetween(frameOf(mesh, a), frameOf(mesh, b))));
        }
    return largest;
}

// Triangles about which tangents turn once or more.
std::vector<uvec3> singularTriangles(const Mesh& mesh) {
    std::vector<uvec3> singular;
    for (const uvec3& triangle : mesh.triangles) {
        float turns = 0;
        for (int i = 0; i < 3; i++)
            turns += turnBetween(frameOf(mesh, triangle[i]), frameOf(mesh, triangle[(i + 1) % 3]));
        if (std::abs(turns) > kPi) singular.push_back(triangle);
    }
    return singular;
}

void checkUnit(const Mesh& mesh) {
    REQUIRE(mesh.tangents.size() == mesh.vertexCount());
    float worst = 0;
    for (size_t i = 0; i < mesh.vertexCount(); i++)
        worst = std::max({worst, std::abs(glm::length(mesh.tangents[i]) - 1),
                          std::abs(glm::dot(mesh.tangents[i], mesh.normals[i]))});
    CHECK(worst < 1e-5f);
}

} // namespace

TEST_CASE("tangents: on a plane they are the normal's, and turn by what is asked for") {
    Mesh plane = makePlane(8, 3);
    makeTangents(plane);
    checkUnit(plane);
    for (const vec3& tangent : plane.tangents) CHECK(glm::distance(tangent, vec3(1, 0, 0)) < 1e-5f);
    makeTangents(plane, 90); // of those that it has
    for (const vec3& tangent : plane.tangents) CHECK(glm::distance(tangent, vec3(0, 0, -1)) < 1e-5f);
}

TEST_CASE("tangents: a sphere's are smooth but for two points, below") {
    Mesh sphere = makeSphere(5);
    makeTangents(sphere);
    checkUnit(sphere);
    const std::vector<uvec3> singular = singularTriangles(sphere);
    CHECK(singular.size() == 2);
    for (const uvec3& triangle : singular) CHECK(sphere.positions[triangle.x].y < -0.8f);
    // Where normals are far from -Y, tangents are nearly those of the normals.
    for (size_t i = 0; i < sphere.vertexCount(); i += 7)
        if (sphere.normals[i].y > 0)
            CHECK(glm::dot(sphere.tangents[i], tangentFrame(sphere.normals[i]).s) > 0.95f);
    const auto isAway = [&](vec3 position) {
        return std::ranges::none_of(singular, [&](uvec3 triangle) {
            return glm::distance(position, sphere.positions[triangle.x]) < 0.2f;
        });
    };
    const float away = largestTurn(sphere, isAway);
    Mesh ofNormals = sphere;
    ofNormals.tangents.clear();
    MESSAGE("largest turn between neighbors: ", away,
            "; of the normals' own frames, anywhere: ", largestTurn(ofNormals, [](vec3) { return true; }));
    CHECK(away < 0.45f);
}

TEST_CASE("tangents: seams of texture coordinates do not break the smooth field") {
    Mesh sphere = makeSphere(3, true);
    REQUIRE(sphere.uvs.size() == sphere.vertexCount());
    sphere.uvs.clear(); // vertices stay split
    makeTangents(sphere);
    size_t pairs = 0;
    for (size_t a = 0; a < sphere.vertexCount(); a++)
        for (size_t b = a + 1; b < sphere.vertexCount(); b++)
            if (sphere.positions[a] == sphere.positions[b] && sphere.normals[a] == sphere.normals[b]) {
                pairs++;
                CHECK(glm::distance(sphere.tangents[a], sphere.tangents[b]) < 1e-6f);
            }
    CHECK(pairs > 0);
}

TEST_CASE("tangents: along u of texture coordinates, also where these are mirrored") {
    for (const float mirror : {1.0f, -1.0f}) {
        Mesh plane = makePlane(4, 2);
        // u goes along (1, 0, 1), v across.
        for (const vec3& p : plane.positions) plane.uvs.emplace_back(p.x + p.z, mirror * (p.x - p.z));
        makeTangents(plane);
        checkUnit(plane);
        for (const vec3& tangent : plane.tangents)
            CHECK(glm::distance(tangent, glm::normalize(vec3(1, 0, 1))) < 1e-5f);
    }
    // Coordinates that tell no direction leave the normal's frame.
    Mesh plane = makePlane(4, 2);
    plane.uvs.assign(plane.vertexCount(), vec2(0.5f));
    makeTangents(plane);
    for (const vec3& tangent : plane.tangents) CHECK(glm::distance(tangent, vec3(1, 0, 0)) < 1e-5f);
}
