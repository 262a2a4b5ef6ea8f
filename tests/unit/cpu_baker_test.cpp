// Tests the CPU baker against the naive twins, stage by stage.
#include "apps/bench/cpu_baker.h"
#include "engine/import/builtin_mesh.h"
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"
#include "precompute/cpu/cpu_visibility.h"
#include "precompute/twins/transport_twin.h"
#include "precompute/twins/vertex_check.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <tbb/global_control.h>

using namespace relume;

namespace {

// Smooth maps with both signs, different for every term.
FactoredBrdf makeMaps(int terms, DiskMapping mapping) {
    constexpr int kSize = 16;
    FactoredBrdf brdf;
    brdf.size = kSize;
    brdf.terms = terms;
    brdf.mapping = mapping;
    for (int term = 0; term < terms; term++)
        for (int y = 0; y < kSize; y++)
            for (int x = 0; x < kSize; x++) {
                const vec2 at = (vec2(x, y) + 0.5f) / float(kSize);
                const float wave = std::sin(float(term + 1) * (3 * at.x + 5 * at.y));
                brdf.lightMaps.emplace_back(1 + wave, wave, at.x * wave);
            }
    return brdf;
}

struct Case {
    std::vector<int> setTerms;
    int faceSize, visibilitySize, samples, coefficients;
    DiskMapping mapping = DiskMapping::EqualArea;
};

Asset makeAsset(const Case& c) {
    Asset asset;
    asset.faceSize = c.faceSize;
    asset.visibilitySize = c.visibilitySize;
    asset.transportSamples = c.samples;
    asset.coefficients = c.coefficients;
    asset.visibilityOffset = 1e-3f;
    asset.occluder = makeKnot(400);
    AssetPart part;
    part.mesh = asset.occluder;
    for (int terms : c.setTerms) part.sets.push_back({{}, makeMaps(terms, c.mapping), {}});
    asset.parts.push_back(std::move(part));
    return asset;
}

BakeOptions cpuOptionsOf(const Asset& asset) {
    BakeOptions options;
    options.faceSize = asset.faceSize;
    options.visibilitySize = asset.visibilitySize;
    options.transportSamples = asset.transportSamples;
    options.coefficients = asset.coefficients;
    return options;
}

std::vector<vec3> denseRow(const PackedRow& row, size_t count) {
    std::vector<vec3> dense(count, vec3(0));
    for (size_t i = 0; i < row.indices.size(); i++)
        dense[row.indices[i]] = vec3(unpackCoefficient(row.values[i])) *
                                (row.scale / vec3(kRedMaximum, kGreenMaximum, kBlueMaximum));
    return dense;
}

void checkCase(const Case& c) {
    CAPTURE(c.faceSize);
    CAPTURE(c.visibilitySize);
    CAPTURE(c.samples);
    CAPTURE(c.coefficients);
    CAPTURE(c.setTerms.size());
    Asset asset = makeAsset(c);
    AssetPart& part = asset.parts.front();
    std::vector<shared::BakePoint> points;
    const size_t stride = part.mesh.vertexCount() / 5;
    for (size_t i = 0; i < 5; i++) points.push_back(bakePoint(part.mesh, i * stride, asset.visibilityOffset));
    std::vector<SparseTransport*> transports;
    for (MaterialSet& set : part.sets) {
        rowsOf(set.transport).vertices = uint32_t(points.size());
        rowsOf(set.transport).terms = uint32_t(set.brdf.terms);
        rowsOf(set.transport).rowStarts = {0};
        transports.push_back(&rowsOf(set.transport));
    }
    CpuBaker baker(asset, part, cpuOptionsOf(asset));
    TransportLosses losses;
    baker.bake(points, transports, losses);
    CHECK_GT(baker.times().rays, 0u);

    const RayTracer tracer(std::array<const Mesh*, 1>{&asset.occluder});
    const size_t count = 6 * size_t(c.faceSize) * size_t(c.faceSize);
    double total = 0, dropped = 0;
    for (size_t set = 0; set < part.sets.size(); set++)
        for (size_t point = 0; point < points.size(); point++) {
            const VertexReference twin = recomputeVertex(asset, 0, set, point * stride, tracer);
            for (size_t term = 0; term < twin.terms.size(); term++) {
                const PackedRow& expected = twin.terms[term].row;
                const PackedRow found = storedRow(rowsOf(part.sets[set].transport), point, term);
                CHECK(found.scale == doctest::Approx(expected.scale).epsilon(1e-4));
                CHECK(std::ranges::is_sorted(found.indices));
                const std::vector<vec3> a = denseRow(found, count), b = denseRow(expected, count);
                double difference = 0, size = 0;
                for (size_t i = 0; i < count; i++) {
                    difference += double(glm::dot(a[i] - b[i], a[i] - b[i]));
                    size += double(glm::dot(b[i], b[i]));
                }
                // A silhouette's texel, an exchange at the N-th place, a step of quantization.
                CHECK_LE(std::sqrt(difference), 3e-3 * std::sqrt(size));
                std::vector<bool> isKept(count, false);
                for (uint16_t index : twin.terms[term].selected) isKept[index] = true;
                for (size_t i = 0; i < count; i++) {
                    const vec3 value = twin.terms[term].coefficients[i];
                    total += double(glm::dot(value, value));
                    if (!isKept[i]) dropped += double(glm::dot(value, value));
                }
            }
        }
    CHECK(losses.total == doctest::Approx(total).epsilon(1e-3));
    CHECK(losses.dropped == doctest::Approx(dropped).epsilon(2e-3));
}

} // namespace

TEST_CASE("cpu baker: bits are the twin's") {
    for (int size : {64, 256}) {
        const Mesh mesh = makeKnot(400);
        const CpuVisibility visibility(mesh, size);
        const RayTracer tracer(std::array<const Mesh*, 1>{&mesh});
        const auto faceTexels = uint32_t(size * size);
        std::vector<uint64_t> bits(visibility.texels() / 64);
        REQUIRE_EQ(visibility.texels(), 6u * faceTexels);
        for (size_t vertex : {size_t(0), mesh.vertexCount() / 3, mesh.vertexCount() - 1}) {
            const vec3 normal = mesh.normals[vertex], origin = mesh.positions[vertex] + 1e-3f * normal;
            const std::vector<uint8_t> expected = visibilityCube(tracer, origin, normal, size);
            uint64_t above = 0, different = 0, seen = 0;
            for (uint32_t i = 0; i < 6 * faceTexels; i++) {
                const int face = int(i / faceTexels);
                const ivec2 place = mortonPlace(i % faceTexels);
                above += glm::dot(cubeTexelDirection(face, place.x, place.y, size), normal) > 0;
            }
            const uint64_t rays = visibility.trace(origin, normal, bits);
            CHECK_EQ(rays, above);
            for (uint32_t i = 0; i < 6 * faceTexels; i++) {
                const ivec2 place = mortonPlace(i % faceTexels);
                const bool isFree = bits[i / 64] >> (i % 64) & 1;
                seen += isFree;
                different +=
                    isFree !=
                    (expected[size_t(cubeTexelIndex(int(i / faceTexels), place.x, place.y, size))] != 0);
            }
            CHECK_GT(seen, 0u);
            CHECK_LE(different, rays / 100000); // rounding at silhouettes
        }
    }
}

TEST_CASE("cpu baker: coefficients are the twin's") {
    for (const Case& c :
         {Case{{1}, 64, 256, 1, 96}, Case{{3}, 64, 256, 4, 96}, Case{{5}, 32, 256, 1, 96},
          Case{{2}, 64, 64, 1, 96}, Case{{1}, 32, 128, 16, 96}, Case{{4}, 64, 128, 1, 96, DiskMapping::Polar},
          Case{{4}, 64, 128, 4, 96, DiskMapping::Orthographic}}) {
        CAPTURE(c.faceSize);
        CAPTURE(c.visibilitySize);
        CAPTURE(c.samples);
        const Asset asset = makeAsset(c);
        const FactoredBrdf& brdf = asset.parts[0].sets[0].brdf;
        const Mesh& mesh = asset.occluder;
        const CpuVisibility visibility(mesh, c.visibilitySize);
        const CpuTransport transport(std::array{&brdf}, c.faceSize, c.visibilitySize, c.samples);
        const vec3 normal = mesh.normals[7], origin = mesh.positions[7] + 1e-3f * normal;
        std::vector<uint64_t> bits(visibility.texels() / 64);
        visibility.trace(origin, normal, bits);
        std::vector<uint8_t> cube(visibility.texels());
        const auto faceTexels = uint32_t(c.visibilitySize * c.visibilitySize);
        for (uint32_t i = 0; i < cube.size(); i++) {
            const ivec2 place = mortonPlace(i % faceTexels);
            cube[size_t(cubeTexelIndex(int(i / faceTexels), place.x, place.y, c.visibilitySize))] =
                bits[i / 64] >> (i % 64) & 1;
        }
        CpuCoefficients found = transport.makeWorkspace();
        // Twice: nothing of the vertex before may remain.
        for (const vec3 frameNormal : {-normal, normal}) {
            transport.evaluate(tangentFrame(frameNormal), bits, found);
            transport.transform(found);
        }
        for (int term = 0; term < brdf.terms; term++) {
            CAPTURE(term);
            std::vector<vec3> expected = transportVector(cube, c.visibilitySize, c.faceSize, c.samples, brdf,
                                                         term, tangentFrame(normal));
            haarForwardFaces(expected, c.faceSize);
            std::vector<vec3> dense(expected.size(), vec3(0));
            const int group = term / found.lanes, lane = term % found.lanes;
            for (size_t block = 0; block < found.blocks.size(); block++)
                for (size_t i = 0; i < 16; i++) {
                    const float* texel = found.block(group, block) + i * size_t(found.stride);
                    const vec3 value(texel[lane], texel[found.lanes + lane], texel[2 * found.lanes + lane]);
                    dense[transport.indices(found.blocks[block])[i]] += value;
                }
            double difference = 0, size = 0;
            for (size_t i = 0; i < expected.size(); i++) {
                difference += double(glm::dot(dense[i] - expected[i], dense[i] - expected[i]));
                size += double(glm::dot(expected[i], expected[i]));
            }
            CHECK_GT(size, 0);
            CHECK_LE(std::sqrt(difference), 1e-5 * std::sqrt(size));
            CHECK(found.energy[size_t(term)] == doctest::Approx(size).epsilon(1e-4));
        }
    }
}

TEST_CASE("cpu baker: rows are the twin's, for every size and sampling") {
    for (const Case& c : {Case{{4}, 64, 256, 1, 96}, Case{{1}, 64, 256, 4, 96}, Case{{2, 3}, 32, 64, 1, 33},
                          Case{{6}, 32, 128, 1, 1}, Case{{1, 1}, 32, 64, 4, 6 * 32 * 32}})
        checkCase(c);
}

TEST_CASE("cpu baker: any number of threads gives the same rows") {
    const Asset asset = makeAsset({{2}, 32, 64, 1, 48});
    const Mesh& mesh = asset.parts[0].mesh;
    std::vector<shared::BakePoint> points;
    for (size_t i = 0; i < 40; i++) points.push_back(bakePoint(mesh, 9 * i, asset.visibilityOffset));
    const auto rowsWith = [&](size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        SparseTransport rows{uint32_t(points.size()), 2, {0}, {}, {}, {}};
        TransportLosses losses;
        CpuBaker(asset, asset.parts[0], cpuOptionsOf(asset)).bake(points, std::array{&rows}, losses);
        return std::pair(rows, losses);
    };
    const auto [alone, lossesAlone] = rowsWith(1);
    const auto [together, lossesTogether] = rowsWith(4);
    REQUIRE_EQ(alone.rows(), 80u);
    CHECK(alone.rowStarts == together.rowStarts);
    CHECK(alone.scales == together.scales);
    CHECK(alone.indices == together.indices);
    CHECK(alone.values == together.values);
    CHECK_EQ(lossesAlone.total, lossesTogether.total);
    CHECK_EQ(lossesAlone.dropped, lossesTogether.dropped);
    CHECK_EQ(lossesAlone.quantized, lossesTogether.quantized);
}
