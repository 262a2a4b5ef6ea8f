// Tests rays against triangles whose hits are known.
#include "precompute/visibility/ray_tracer.h"

#include "engine/import/builtin_mesh.h"
#include "tests/support/diffuse_asset.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

RayTracer makeTracer(std::initializer_list<const Mesh*> meshes) {
    return RayTracer(std::span(meshes.begin(), meshes.size()));
}

std::vector<uint8_t> occluded(const RayTracer& tracer, vec3 origin, const std::vector<vec3>& directions) {
    std::vector<uint8_t> blocked(directions.size(), 2);
    tracer.occluded(origin, directions, blocked);
    return blocked;
}

std::vector<vec3> randomDirections(int count) {
    std::mt19937 random(1);
    std::normal_distribution<float> gauss;
    std::vector<vec3> directions;
    for (int i = 0; i < count; i++)
        directions.push_back(glm::normalize(vec3(gauss(random), gauss(random), gauss(random))));
    return directions;
}

} // namespace

TEST_CASE("ray tracer: a hit names mesh, triangle, weights and distance") {
    const Mesh empty;
    const Mesh triangle{{{0, 0, -2}, {1, 0, -2}, {0, 1, -2}}, {}, {{0, 1, 2}}};
    const Mesh behind = makeQuad({-5, -5, -7}, {10, 0, 0}, {0, 10, 0});
    const RayTracer tracer = makeTracer({&empty, &triangle, &behind});

    const auto near = tracer.intersect({0.25f, 0.5f, 0}, {0, 0, -1});
    REQUIRE(near);
    CHECK(near->mesh == 1);
    CHECK(near->triangle == 0);
    CHECK(near->distance == doctest::Approx(2));
    CHECK(glm::length(near->weights - vec3(0.25f, 0.25f, 0.5f)) < 1e-5f);

    const auto far = tracer.intersect({-1, 0, 0}, {0, 0, -1}); // upper left of the quad
    REQUIRE(far);
    CHECK(far->mesh == 2);
    CHECK(far->triangle == 1);
    CHECK(far->distance == doctest::Approx(7));

    CHECK_FALSE(tracer.intersect({0.25f, 0.5f, 0}, {0, 0, 1}));
}

TEST_CASE("ray tracer: without triangles nothing is blocked") {
    const Mesh empty;
    for (const RayTracer& tracer : {makeTracer({}), makeTracer({&empty})}) {
        CHECK_FALSE(tracer.intersect(vec3(0), {0, 0, 1}));
        const std::vector<uint8_t> blocked = occluded(tracer, vec3(0), randomDirections(300));
        CHECK(std::count(blocked.begin(), blocked.end(), 0) == 300);
    }
}

TEST_CASE("ray tracer: no ray leaves a closed mesh, not even through its edges and vertices") {
    const Mesh sphere = makeSphere(3);
    const RayTracer tracer = makeTracer({&sphere});
    std::vector<vec3> directions = randomDirections(5000);
    for (const uvec3& t : sphere.triangles) {
        const vec3 a = sphere.positions[t.x], b = sphere.positions[t.y];
        directions.insert(directions.end(), {a, 0.5f * (a + b), 0.3f * a + 0.7f * b});
    }
    const std::vector<uint8_t> blocked = occluded(tracer, vec3(0), directions);
    CHECK(std::count(blocked.begin(), blocked.end(), 1) == std::ptrdiff_t(directions.size()));
}

TEST_CASE("ray tracer: occlusion is whether there is a hit, for any number of rays") {
    const Mesh torus = makeTorus(1.0f, 0.3f, 40, 20);
    const RayTracer tracer = makeTracer({&torus});
    for (int count : {0, 1, 7, 256, 257, 1000}) {
        const std::vector<vec3> directions = randomDirections(count);
        const std::vector<uint8_t> blocked = occluded(tracer, {0, 0.4f, 0}, directions);
        int mismatches = 0, hits = 0;
        for (int i = 0; i < count; i++) {
            const bool isHit = tracer.intersect({0, 0.4f, 0}, directions[size_t(i)]).has_value();
            mismatches += blocked[size_t(i)] != isHit;
            mismatches += tracer.occluded({0, 0.4f, 0}, directions[size_t(i)]) != isHit;
            hits += isHit;
        }
        CHECK(mismatches == 0);
        if (count >= 256) CHECK((hits > count / 10 && hits < count * 9 / 10)); // both kinds occur
    }
}
