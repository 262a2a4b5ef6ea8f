// Rasterized and traced visibility against closed forms, against Embree and against each other.
#include "engine/base/error.h"
#include "engine/import/builtin_mesh.h"
#include "engine/math/cubemap.h"
#include "precompute/bake/bake.h"
#include "precompute/twins/transport_twin.h"
#include "precompute/visibility/occluder.h"
#include "precompute/visibility/raster_visibility.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace relume;

namespace {

// One cube of 0 and 1 a point, as the device sees it.
std::vector<std::vector<uint8_t>> visibilityOf(const vk::Device& device, const Visibility& visibility,
                                               const std::vector<shared::BakePoint>& points, uint32_t size,
                                               uint32_t batch) {
    const vk::Buffer pointBuffer(device, batch * sizeof(shared::BakePoint), vk::BufferUse::Upload, "points");
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
        visibility.check();
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

std::vector<std::vector<uint8_t>> visibilityOf(const vk::Device& device, VisibilityMethod method,
                                               const Mesh& occluder,
                                               const std::vector<shared::BakePoint>& points, uint32_t size,
                                               uint32_t batch, float nearDistance) {
    const auto visibility = makeVisibility(device, method, occluder, size, batch, nearDistance);
    return visibilityOf(device, *visibility, points, size, batch);
}

// Returns the methods that the device can use.
std::vector<VisibilityMethod> methodsOf(const vk::Device& device) {
    if (canUse(device, VisibilityMethod::Traced)) return {VisibilityMethod::Raster, VisibilityMethod::Traced};
    return {VisibilityMethod::Raster};
}

size_t differences(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    size_t count = 0;
    for (size_t i = 0; i < a.size(); i++) count += a[i] != b[i];
    return count;
}

} // namespace

TEST_CASE("visibility: a sphere alone sees everything above its horizon") {
    const TestDevice device;
    const Mesh sphere = makeSphere(3);
    const std::vector<shared::BakePoint> points = somePoints(sphere, 10, 1e-4f);
    for (const VisibilityMethod method : methodsOf(device)) {
        const auto cubes = visibilityOf(device, method, sphere, points, 64, 4, 1e-7f);
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
}

TEST_CASE("visibility: under a wide ceiling with a hole only the hole is seen") {
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
    for (const VisibilityMethod method : methodsOf(device)) {
        const auto cubes = visibilityOf(device, method, ceiling, {{{0, 0, 0}, {0, 1, 0}}}, 64, 1, 1e-4f);
        for (int face = 0; face < 6; face++)
            for (int y = 0; y < 64; y++)
                for (int x = 0; x < 64; x++) {
                    const bool expected = face == 2;
                    // A row next to the horizon looks past the ceiling's far edge.
                    if (!expected && cubeTexelDirection(face, x, y, 64).y < 1e-3f) continue;
                    REQUIRE_EQ(cubes[0][size_t(cubeTexelIndex(face, x, y, 64))], expected);
                }
    }
}

TEST_CASE("visibility: agrees with Embree but at silhouettes") {
    const TestDevice device;
    const Mesh knot = makeKnot(2000);
    const float offset = 1e-4f * boundsOf(knot).radius();
    const std::vector<shared::BakePoint> points = somePoints(knot, 24, offset);
    const Mesh* occluder = &knot;
    const RayTracer tracer({&occluder, 1});
    for (const int size : {64, 128, 256}) {
        size_t blocked = 0;
        std::vector<std::vector<uint8_t>> expected;
        for (const shared::BakePoint& point : points) {
            expected.push_back(visibilityCube(tracer, point.origin, point.normal, size));
            blocked += expected[0].size() / 2 - size_t(std::ranges::count(expected.back(), 1));
        }
        const double hemispheres = double(points.size()) * double(expected[0].size()) / 2;
        CHECK_GT(double(blocked) / hemispheres, 0.05); // else the knot tests nothing
        for (const VisibilityMethod method : methodsOf(device)) {
            const auto cubes =
                visibilityOf(device, method, knot, points, uint32_t(size), 7, visibilityNearDistance(offset));
            size_t mismatched = 0;
            for (size_t point = 0; point < points.size(); point++)
                mismatched += differences(cubes[point], expected[point]);
            // Rays do as Embree's do; the rasterizer rounds corners to a fraction of a texel.
            CHECK_LT(double(mismatched) / hemispheres, method == VisibilityMethod::Traced ? 2e-5 : 0.005);
        }
    }
}

TEST_CASE("visibility: traced and rasterized differ only at silhouettes") {
    const TestDevice device;
    if (!canUse(device, VisibilityMethod::Traced)) return;
    constexpr int kSize = 128;
    for (const Mesh& mesh : {makeKnot(3000), makeTorus(1, 0.4f, 60, 25), makeSphere(4)}) {
        const float offset = 1e-4f * boundsOf(mesh).radius();
        const std::vector<shared::BakePoint> points = somePoints(mesh, 16, offset);
        const auto cubesOf = [&](VisibilityMethod method) {
            return visibilityOf(device, method, mesh, points, kSize, 16, visibilityNearDistance(offset));
        };
        const auto traced = cubesOf(VisibilityMethod::Traced), raster = cubesOf(VisibilityMethod::Raster);
        size_t different = 0, inside = 0;
        for (size_t point = 0; point < points.size(); point++)
            for (int texel = 0; texel < 6 * kSize * kSize; texel++) {
                if (traced[point][size_t(texel)] == raster[point][size_t(texel)]) continue;
                different++;
                // A silhouette passes through the texel: one of its neighbors in the face is not like it.
                const int face = texel / (kSize * kSize), y = texel / kSize % kSize, x = texel % kSize;
                bool border = x == 0 || y == 0 || x == kSize - 1 || y == kSize - 1;
                for (int dy = -1; dy <= 1 && !border; dy++)
                    for (int dx = -1; dx <= 1; dx++)
                        border =
                            border || traced[point][size_t(cubeTexelIndex(face, x + dx, y + dy, kSize))] !=
                                          traced[point][size_t(texel)];
                inside += !border;
            }
        CHECK_LT(double(different) / (double(points.size()) * 3 * kSize * kSize), 0.005);
        CHECK_EQ(inside, 0u);
    }
}

TEST_CASE("visibility: no ray slips out of a closed mesh") {
    const TestDevice device;
    const Mesh sphere = makeSphere(5); // texels that touch an edge of its 20,480 triangles are plenty
    std::vector<shared::BakePoint> points;
    for (const vec3 at : {vec3(0), vec3(0.31f, -0.2f, 0.4f), vec3(0, 0.9f, 0)})
        for (const vec3 normal : {vec3(0, 1, 0), vec3(0, -1, 0), glm::normalize(vec3(1, -2, 3))})
            points.push_back({at, normal});
    for (const VisibilityMethod method : methodsOf(device))
        for (const std::vector<uint8_t>& cube : visibilityOf(device, method, sphere, points, 256, 9, 1e-7f))
            CHECK_EQ(std::ranges::count(cube, 1), 0);
}

TEST_CASE("visibility: traced rays through corners and along edges are blocked") {
    // A wall whose corners all lie on the centers of texels: every ray of the face meets a corner, none an
    // inside.
    const TestDevice device;
    if (!canUse(device, VisibilityMethod::Traced)) return;
    constexpr uint32_t kSize = 64;
    Mesh wall;
    for (uint32_t y = 0; y < kSize; y++)
        for (uint32_t x = 0; x < kSize; x++)
            wall.positions.emplace_back((2 * float(x) + 1) / kSize - 1, (2 * float(y) + 1) / kSize - 1, 1);
    for (uint32_t y = 0; y + 1 < kSize; y++)
        for (uint32_t x = 0; x + 1 < kSize; x++) {
            const uint32_t a = y * kSize + x, b = a + 1, c = a + kSize, d = c + 1;
            wall.triangles.push_back({a, b, (x + y) % 2 ? c : d});
            wall.triangles.push_back({(x + y) % 2 ? b : a, d, c});
        }
    const auto cubes =
        visibilityOf(device, VisibilityMethod::Traced, wall, {{{0, 0, 0}, {0, 0, 1}}}, kSize, 1, 1e-7f);
    int free = 0;
    for (int y = 0; y < int(kSize); y++)
        for (int x = 0; x < int(kSize); x++) free += cubes[0][size_t(cubeTexelIndex(4, x, y, int(kSize)))];
    CHECK_EQ(free, 0);
}

TEST_CASE("visibility: layers drawn one by one have the bits of those drawn together") {
    const TestDevice device;
    if (!static_cast<const vk::Device&>(device).info().outputsLayers) return;
    constexpr uint32_t kSize = 64, kBatch = 5;
    const Mesh mesh = makeKnot(3000);
    const float offset = 1e-4f * boundsOf(mesh).radius(), near = visibilityNearDistance(offset);
    const std::vector<shared::BakePoint> points = somePoints(mesh, 13, offset); // the last batch is not full
    using enum RasterVisibility::Layers;
    const auto draw = [&](RasterVisibility::Layers layers) {
        const RasterVisibility visibility(device, mesh, kSize, kBatch, near, RasterVisibility::Culling::On,
                                          layers);
        return visibilityOf(device, visibility, points, kSize, kBatch);
    };
    CHECK(draw(OneByOne) == draw(Together));
}

TEST_CASE("visibility: clusters and front faces that are left out change nothing") {
    const TestDevice device;
    constexpr uint32_t kSize = 128, kBatch = 8;
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(3000), "clay", "built-in knot", ""});
    addGround(scene, {.tessellation = 4}, "white-diffuse");
    const Mesh knotOnGround = makeOccluder(scene, 0).mesh;
    for (const Mesh& mesh : {makeKnot(3000), makeTorus(1, 0.4f, 80, 25), knotOnGround}) {
        Mesh vertices = mesh;
        if (vertices.normals.empty()) vertices = scene.parts[1].mesh; // those of the ground
        const float offset = 1e-4f * boundsOf(mesh).radius(), near = visibilityNearDistance(offset);
        const std::vector<shared::BakePoint> points = somePoints(vertices, 24, offset);
        const RasterVisibility culled(device, mesh, kSize, kBatch, near);
        const RasterVisibility all(device, mesh, kSize, kBatch, near, RasterVisibility::Culling::Off,
                                   static_cast<const vk::Device&>(device).info().outputsLayers
                                       ? RasterVisibility::Layers::Together
                                       : RasterVisibility::Layers::OneByOne);
        const auto fewer = visibilityOf(device, culled, points, kSize, kBatch);
        const auto expected = visibilityOf(device, all, points, kSize, kBatch);
        size_t differ = 0;
        for (size_t point = 0; point < points.size(); point++)
            differ += differences(fewer[point], expected[point]);
        // SwiftShader culls before it rounds corners: of 2.4 million texels it loses two at silhouettes.
        CHECK_LE(differ, roundsFinely(device) ? 0u : 4u);
    }
}

TEST_CASE("visibility: a device that gives up tracing says so") {
    // Hundreds of thousands of needles in one tile, none of which hides another: more turns of a loop than
    // some devices take.
    const TestDevice device;
    if (!canUse(device, VisibilityMethod::Traced)) return;
    Mesh needles;
    for (uint32_t i = 0; i < 300'000; i++) {
        const float x = -0.1f + 0.001f * float(i % 200), y = 0.05f + 0.00015f * float(i / 200 % 1500);
        const vec3 base(x, y, 1 + 1e-3f * float(i % 7));
        needles.positions.insert(needles.positions.end(),
                                 {base, base + vec3(0.02f, 0.02f, 0), base + vec3(0.02f, 0.02f + 1e-7f, 0)});
        needles.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    // A wall behind them hides much.
    needles.positions.insert(needles.positions.end(), {{-5, 0, 3}, {5, 0, 3}, {0, 9, 3}});
    needles.triangles.push_back(uvec3(0, 1, 2) + uint32_t(needles.positions.size() - 3));
    const std::vector<shared::BakePoint> points = {{{0, 0, 0}, {0, 1, 0}}};
    const Mesh* occluder = &needles;
    const RayTracer tracer({&occluder, 1});
    const auto expected = visibilityCube(tracer, points[0].origin, points[0].normal, 256);
    try {
        const auto cubes = visibilityOf(device, VisibilityMethod::Traced, needles, points, 256, 1, 1e-7f);
        CHECK_LT(differences(cubes[0], expected), 60u);
    } catch (const Error& failure) {
        CHECK(std::string(failure.what()).find("--visibility raster") != std::string::npos);
    }
}

TEST_CASE("visibility: an empty occluder blocks nothing") {
    const TestDevice device;
    for (const VisibilityMethod method : methodsOf(device)) {
        const auto cubes = visibilityOf(device, method, {}, {{{0, 0, 0}, {0, 0, 1}}}, 64, 1, 1e-4f);
        CHECK_EQ(std::ranges::count(cubes[0], 1), 3 * 64 * 64);
    }
}
