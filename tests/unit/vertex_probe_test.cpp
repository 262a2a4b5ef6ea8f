// Tests that the explanation of a vertex adds up to its radiance.
#include "precompute/error/vertex_probe.h"

#include "engine/math/cubemap.h"
#include "precompute/twins/relight_twin.h"
#include "precompute/twins/vertex_check.h"
#include "tests/support/asset_sample.h"
#include "tests/support/diffuse_asset.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

LightCube makeLight(int size) {
    LightCube light{size, {}};
    for (int i = 0; i < 6 * size * size; i++)
        light.radiance.push_back(vec3(float(i % 17), float(i % 5) + 1, float(i % 29) * 0.5f));
    return light;
}

RayTracer occluderOf(const Asset& asset) {
    const Mesh* mesh = &asset.occluder;
    return RayTracer({&mesh, 1});
}

vec3 innerProduct(const LightCube& a, const LightCube& b) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < a.radiance.size(); i++)
        sum += glm::dvec3(a.radiance[i]) * glm::dvec3(b.radiance[i]);
    return vec3(sum);
}

double distance(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    double squares = 0;
    for (size_t i = 0; i < a.size(); i++) squares += double(glm::dot(a[i] - b[i], a[i] - b[i]));
    return std::sqrt(squares);
}

// A diffuse quad on the ground, and beside its corners a wall; rows of all coefficients.
Asset bakeCourt() {
    Asset asset = makeTestAsset({makeDiffusePart(makeQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), 0.5f)});
    append(asset.occluder, makeQuad({-1.5f, 0, -3}, {0, 2, 0}, {0, 0, 6}));
    asset.faceSize = 16, asset.visibilitySize = 64, asset.coefficients = 6 * 16 * 16;
    const RayTracer tracer = occluderOf(asset);
    SparseTransport& rows = rowsOf(asset.parts[0].sets[0].transport);
    rows.vertices = 4, rows.terms = 1, rows.rowStarts = {0};
    for (size_t vertex = 0; vertex < 4; vertex++) {
        const PackedRow row = recomputeVertex(asset, 0, 0, vertex, tracer).terms[0].row;
        rows.indices.insert(rows.indices.end(), row.indices.begin(), row.indices.end());
        rows.values.insert(rows.values.end(), row.values.begin(), row.values.end());
        rows.scales.push_back(row.scale);
        rows.rowStarts.push_back(rows.values.size());
    }
    return asset;
}

} // namespace

TEST_CASE("vertex probe: tuple and transport give the same radiance, in every layout and material") {
    const Asset asset = mixedAsset();
    const CpuVisibility occluder(asset.occluder, asset.visibilitySize);
    const LightCube light = makeLight(asset.faceSize);
    const LightVector vector = makeLightVector(light, {.threshold = 2000});
    REQUIRE(vector.error > 0.01f); // something is dropped
    Appearance blend = defaultAppearance(asset), other = blend;
    blend[0] = {0, {0.75f, 0.5f}, false};
    other[0] = {1, {2}, false};
    for (const Appearance& appearance : {defaultAppearance(asset), blend, other})
        for (size_t part = 0; part < asset.parts.size(); part++) {
            CAPTURE(part);
            const AssetPart& source = asset.parts[part];
            const MaterialSet& set = source.sets[appearance[part].set];
            const std::vector<vec3> tuples = relight(set.transport, vector);
            const auto terms = size_t(set.brdf.terms);
            for (uint32_t vertex = 0; vertex < source.mesh.vertexCount(); vertex += 5) {
                const vec3 eye = source.mesh.positions[vertex] + 2.0f * source.mesh.normals[vertex] +
                                 vec3(0.3f, 0.1f, -0.4f);
                const VertexProbe probe =
                    probeVertex(asset, occluder, part, vertex, eye, appearance[part], light, vector);
                REQUIRE(probe.tuple.size() == terms);
                REQUIRE(probe.views.size() == terms);
                const auto first = tuples.begin() + std::ptrdiff_t(vertex * terms);
                const std::vector<vec3> expected(first, first + std::ptrdiff_t(terms));
                CHECK(distance(probe.tuple, expected) <=
                      1e-5 * distance(expected, std::vector<vec3>(terms, vec3(0))));

                vec3 sum(0), size(0);
                for (size_t term = 0; term < terms; term++) {
                    sum += probe.views[term] * probe.tuple[term];
                    size += glm::abs(probe.views[term] * probe.tuple[term]);
                }
                const float rounding = 1e-5f * (size.x + size.y + size.z) + 1e-4f;
                CHECK(glm::length(probe.radiance - sum) < rounding);
                CHECK(glm::length(innerProduct(reconstruct(vector), probe.transport) - sum) < rounding);
                CHECK(glm::length(innerProduct(light, probe.transport) - probe.fullRadiance) < rounding);
            }
        }
}

TEST_CASE("vertex probe: layers show as much as they are bound") {
    Asset asset = mixedAsset();
    const CpuVisibility occluder(asset.occluder, asset.visibilitySize);
    const LightCube light = makeLight(asset.faceSize);
    const LightVector vector = makeLightVector(light);
    const auto views = [&](const PartAppearance& appearance) {
        return probeVertex(asset, occluder, 0, 4, {1, 2, 3}, appearance, light, vector).views;
    };
    const FactoredBrdf& brdf = asset.parts[0].sets[0].brdf;
    const Mesh& mesh = asset.parts[0].mesh;
    const vec3 outgoing = liftAboveHorizon(
        tangentFrame(mesh.normals[4]).toLocal(glm::normalize(vec3(1, 2, 3) - mesh.positions[4])));
    // All layers of the sample are alike.
    const vec3 map = lookupMap(brdf.viewMap(0, 1), brdf.size, brdf.mapping, outgoing);
    const vec3 base(sample(*asset.parts[0].baseColor, mesh.uvs[4]));
    CHECK(glm::length(views({0, {0.25f, 0}, false})[1] - 0.25f * map) < 1e-6f);
    CHECK(glm::length(views({0, {0, 0.5f}, false})[1] - 0.5f * (1.0f + base) * map) < 1e-6f);
    const vec4 paint = paintWeights(sample(*asset.parts[0].materialMap, mesh.uvs[4]), 2);
    const vec3 painted = (paint.x + paint.y * (1.0f + base)) * map;
    CHECK(glm::length(views({0, {1, 0}, true})[1] - painted) < 1e-6f);
}

TEST_CASE("vertex probe: of a diffuse vertex, transport is albedo / π · cosine · solid angle · visibility") {
    const Asset asset = bakeCourt();
    const CpuVisibility occluder(asset.occluder, asset.visibilitySize);
    const int size = asset.faceSize;
    const LightCube light{size, std::vector<vec3>(size_t(6 * size * size), vec3(1))};
    for (uint32_t vertex = 0; vertex < 4; vertex++) {
        const VertexProbe probe = probeVertex(asset, occluder, 0, vertex, {3, 4, 1}, {0, {1}, false}, light,
                                              makeLightVector(light));
        std::vector<vec3> expected;
        float visible = 0;
        for (int i = 0; i < 6 * size * size; i++) {
            const int x = i % size, y = i / size % size;
            const vec3 direction = cubeTexelDirection(i / (size * size), x, y, size);
            expected.push_back(vec3(0.5f / kPi * std::max(direction.y, 0.0f) *
                                    cubeTexelSolidAngle(x, y, size) * probe.visibility[size_t(i)]));
            visible += probe.visibility[size_t(i)] * cubeTexelSolidAngle(x, y, size);
        }
        CHECK(distance(probe.transport.radiance, expected) <
              0.02 * distance(expected, std::vector<vec3>(expected.size(), vec3(0))));
        const bool isByTheWall = asset.parts[0].mesh.positions[vertex].x < 0;
        CHECK(visible < (isByTheWall ? 1.35f : 1.85f) * kPi);
        CHECK(visible > (isByTheWall ? 1.1f : 1.6f) * kPi);
        CHECK(glm::length(probe.radiance - probe.fullRadiance) < 0.01f * probe.radiance.y);
        if (!isByTheWall) CHECK(probe.radiance.y == doctest::Approx(0.48).epsilon(0.05));
    }
    CHECK(probeVertex(asset, occluder, 0, 0, {3, 4, 1}, {0, {1}, false}, light, makeLightVector(light))
              .visibility[size_t(cubeTexelIndex(3, 8, 8, size))] == 0); // below the horizon
}
