// Rasterised visibility against closed forms and against Embree.
#include "engine/math/cubemap.h"
#include "engine/scene/builtin_mesh.h"
#include "precompute/reference/transport_stages.h"
#include "precompute/visibility/raster_visibility.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>

using namespace relume;

namespace {

// One cube of 0 and 1 a point, as the device sees it.
std::vector<std::vector<uint8_t>> visibilityOf(const vk::Device& device, const Mesh& occluder,
                                               const std::vector<shared::BakePoint>& points, uint32_t size,
                                               uint32_t batch, float nearDistance) {
    const vk::Buffer pointBuffer(device, batch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points");
    const RasterVisibility visibility(device, occluder, size, batch, nearDistance);
    const uint64_t pointBytes = visibilityBytes(size);
    const vk::Buffer bits(device, batch * pointBytes, vk::BufferUse::Device, "bits");
    const vk::Buffer back(device, batch * pointBytes, vk::BufferUse::Readback, "bits back");
    vk::Commands commands(device, "visibility test");
    std::vector<std::vector<uint8_t>> cubes;
    for (uint32_t first = 0; first < points.size(); first += batch) {
        const uint32_t count = std::min(batch, uint32_t(points.size()) - first);
        std::copy_n(points.begin() + first, count, pointBuffer.map<shared::BakePoint>().begin());
        commands.begin();
        visibility.record(commands, pointBuffer, count, bits);
        commands.barrier(vk::Stage::Compute, vk::Stage::Transfer);
        commands.copy(bits, back, count * pointBytes);
        commands.barrier(vk::Stage::Transfer, vk::Stage::Host);
        commands.submitAndWait();
        const std::span<uint32_t> words = back.map<uint32_t>();
        for (uint32_t point = 0; point < count; point++) {
            std::vector<uint8_t>& cube = cubes.emplace_back(pointBytes * 8);
            for (size_t texel = 0; texel < cube.size(); texel++)
                cube[texel] = words[point * pointBytes / 4 + texel / 32] >> texel % 32 & 1;
        }
    }
    return cubes;
}

std::vector<shared::BakePoint> somePoints(const Mesh& mesh, size_t count, float offset) {
    std::vector<shared::BakePoint> points;
    for (size_t i = 0; i < count; i++) {
        const size_t vertex = i * mesh.vertexCount() / count;
        points.push_back(bakePoint(mesh, vertex, offset));
    }
    return points;
}

} // namespace

TEST_CASE("raster visibility: a sphere alone sees everything above its horizon") {
    const TestDevice device;
    const Mesh sphere = makeSphere(3);
    const std::vector<shared::BakePoint> points = somePoints(sphere, 10, 1e-4f);
    const auto cubes = visibilityOf(device, sphere, points, 64, 4, 1e-7f);
    for (size_t point = 0; point < points.size(); point++) {
        int wrong = 0;
        for (int texel = 0; texel < 6 * 64 * 64; texel++) {
            const vec3 direction = cubeTexelDirection(texel / 4096, texel % 64, texel / 64 % 64, 64);
            // Faceted: within half a texel of the horizon a facet may rise above the tangent plane's
            // rounding.
            const float cosine = glm::dot(direction, points[point].normal);
            if (std::abs(cosine) < 1e-5f) continue;
            wrong += cubes[point][size_t(texel)] != (cosine > 0);
        }
        CHECK_EQ(wrong, 0);
    }
}

TEST_CASE("raster visibility: under a wide ceiling with a hole only the hole is seen") {
    const TestDevice device;
    // A ceiling at height 1, open where |x| < 1 and |z| < 1: exactly the +Y face of a point at the origin.
    Mesh ceiling;
    const float far = 1e4f;
    const auto quad = [&](float x0, float x1, float z0, float z1) {
        const auto first = uint32_t(ceiling.positions.size());
        for (const vec2 corner : {vec2(x0, z0), vec2(x1, z0), vec2(x1, z1), vec2(x0, z1)})
            ceiling.positions.emplace_back(corner.x, 1.0f, corner.y);
        ceiling.triangles.emplace_back(first, first + 1, first + 2);
        ceiling.triangles.emplace_back(first, first + 2, first + 3);
    };
    quad(-far, -1, -far, far);
    quad(1, far, -far, far);
    quad(-1, 1, -far, -1);
    quad(-1, 1, 1, far);
    const auto cubes = visibilityOf(device, ceiling, {{{0, 0, 0}, {0, 1, 0}}}, 64, 1, 1e-4f);
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++) {
                const bool expected = face == 2;
                // A row next to the horizon looks past the ceiling's far edge.
                if (!expected && cubeTexelDirection(face, x, y, 64).y < 1e-3f) continue;
                REQUIRE_EQ(cubes[0][size_t(cubeTexelIndex(face, x, y, 64))], expected);
            }
}

TEST_CASE("raster visibility: agrees with Embree but at silhouettes") {
    const TestDevice device;
    const Mesh knot = makeKnot(2000);
    const float offset = 1e-4f * boundsOf(knot).radius();
    const std::vector<shared::BakePoint> points = somePoints(knot, 24, offset);
    const Mesh* occluder = &knot;
    const RayTracer tracer({&occluder, 1});
    for (const int size : {64, 128, 256}) {
        const auto cubes =
            visibilityOf(device, knot, points, uint32_t(size), 7, visibilityNearDistance(offset));
        size_t mismatched = 0, hemisphere = 0, blocked = 0;
        for (size_t point = 0; point < points.size(); point++) {
            const std::vector<uint8_t> expected =
                visibilityCube(tracer, points[point].origin, points[point].normal, size);
            for (size_t texel = 0; texel < expected.size(); texel++)
                mismatched += expected[texel] != cubes[point][texel];
            hemisphere += expected.size() / 2;
            blocked += expected.size() / 2 - size_t(std::count(expected.begin(), expected.end(), 1));
        }
        CHECK_GT(double(blocked) / double(hemisphere), 0.05); // else the knot tests nothing
        CHECK_LT(double(mismatched) / double(hemisphere), 0.005);
    }
}

TEST_CASE("raster visibility: an empty occluder blocks nothing") {
    const TestDevice device;
    const auto cubes = visibilityOf(device, {}, {{{0, 0, 0}, {0, 0, 1}}}, 64, 1, 1e-4f);
    CHECK_EQ(std::count(cubes[0].begin(), cubes[0].end(), 1), 3 * 64 * 64);
}
