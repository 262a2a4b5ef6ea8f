// Tests each stage of the bake's CPU twin against closed forms.
#include "engine/math/haar.h"
#include "precompute/twins/relight_twin.h"
#include "precompute/twins/transport_twin.h"

#include "engine/import/builtin_mesh.h"
#include "engine/math/cubemap.h"
#include "tests/support/diffuse_asset.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <limits>
#include <numeric>
#include <random>

using namespace relume;
using namespace relume::test;

namespace {

RayTracer makeTracer(const Mesh& mesh) {
    const Mesh* meshes[] = {&mesh};
    return RayTracer(meshes);
}

// Number of texels whose visibility is not what `isVisible` says of their direction.
template <typename Predicate>
int mismatches(const std::vector<uint8_t>& visibility, int size, const Predicate& isVisible) {
    int count = 0;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++)
                count += visibility[size_t(cubeTexelIndex(face, x, y, size))] !=
                         isVisible(cubeTexelDirection(face, x, y, size));
    return count;
}

vec3 sum(const std::vector<vec3>& values) { return std::accumulate(values.begin(), values.end(), vec3(0)); }

std::vector<vec3> randomValues(size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<vec3> values(count);
    for (vec3& value : values) value = {uniform(random), uniform(random), uniform(random)};
    return values;
}

double relativeDistance(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    double difference = 0, norm = 0;
    for (size_t i = 0; i < a.size(); i++) {
        difference += double(glm::dot(a[i] - b[i], a[i] - b[i]));
        norm += double(glm::dot(b[i], b[i]));
    }
    return std::sqrt(difference / norm);
}

} // namespace

TEST_CASE("visibility: a vertex of a convex mesh sees all texels above its horizon and no others") {
    const int size = 64;
    const Mesh sphere = makeSphere(2);
    const RayTracer tracer = makeTracer(sphere);
    for (size_t vertex = 0; vertex < sphere.vertexCount(); vertex += 20) {
        const vec3 normal = sphere.normals[vertex];
        const auto visibility =
            visibilityCube(tracer, sphere.positions[vertex] + 1e-4f * normal, normal, size);
        REQUIRE(visibility.size() == size_t(6 * size * size));
        CHECK(mismatches(visibility, size, [&](vec3 d) { return glm::dot(d, normal) > 0; }) == 0);
    }
}

TEST_CASE("visibility: under a square roof, the texels that it covers are dark") {
    const int size = 64;
    const Mesh roof = makeQuad({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}); // covers half of u and v of face +Y
    const auto visibility = visibilityCube(makeTracer(roof), vec3(0), {0, 1, 0}, size);
    CHECK(mismatches(visibility, size, [](vec3 d) {
              const bool isCovered = std::abs(d.x) < 0.5f * d.y && std::abs(d.z) < 0.5f * d.y;
              return d.y > 0 && !isCovered;
          }) == 0);
    CHECK(std::count(visibility.begin(), visibility.end(), 1) == 3 * size * size - size * size / 4);
}

TEST_CASE("transport: of a constant light map, sums to π in the open and π / 2 beside a wall") {
    const Mesh nothing;
    const Mesh wall = makeQuad({1e-3f, -1e3f, -1e3f}, {0, 2e3f, 0}, {0, 0, 2e3f});
    const FactoredBrdf brdf = makeDiffuseFactors(vec3(0.5f));
    const vec3 normal(0, 1, 0);
    for (int samples : {1, 4, 16}) {
        const auto open = visibilityCube(makeTracer(nothing), vec3(0), normal, 256);
        const auto half = visibilityCube(makeTracer(wall), vec3(0), normal, 256);
        const vec3 full = sum(transportVector(open, 256, 64, samples, brdf, 0, tangentFrame(normal)));
        const vec3 beside = sum(transportVector(half, 256, 64, samples, brdf, 0, tangentFrame(normal)));
        CHECK(full.x == doctest::Approx(kPi).epsilon(1e-3));
        CHECK(beside.x == doctest::Approx(kPi / 2).epsilon(1e-3));
    }
}

TEST_CASE("transport: a constant light map under a tilted normal still sums to g π") {
    const Mesh nothing;
    FactoredBrdf brdf = makeDiffuseFactors(vec3(1));
    brdf.terms = 2;
    brdf.lightMaps.insert(brdf.lightMaps.end(), brdf.mapTexels(), vec3(0.1f, 0.2f, -0.3f));
    const vec3 normal = glm::normalize(vec3(0.3f, -0.8f, 0.4f));
    const auto visibility = visibilityCube(makeTracer(nothing), vec3(0), normal, 64);
    for (int samples : {1, 4}) {
        const auto transport = transportVector(visibility, 64, 32, samples, brdf, 1, tangentFrame(normal));
        REQUIRE(transport.size() == 6 * 32 * 32);
        CHECK(glm::length(sum(transport) - kPi * vec3(0.1f, 0.2f, -0.3f)) < 5e-3f * kPi * 0.37f);
    }
}

TEST_CASE("transport: the finest samples are the sum over visibility texels, one sample is close") {
    const int size = 64, faceSize = 16, children = size / faceSize;
    const Mesh roof = makeQuad({-0.3f, 0.7f, -0.2f}, {1, 0, 0}, {0, 0.4f, 1});
    const vec3 normal = glm::normalize(vec3(0.2f, 1, -0.1f));
    const TangentFrame frame = tangentFrame(normal);
    FactoredBrdf brdf = makeDiffuseFactors(vec3(1), 16);
    brdf.mapping = DiskMapping::Polar;
    for (int i = 0; i < 256; i++) brdf.lightMaps[size_t(i)] = vec3(1 + i % 16, 2 + i / 16, 3);
    const auto visibility = visibilityCube(makeTracer(roof), vec3(0), normal, size);

    std::vector<vec3> expected(6 * faceSize * faceSize, vec3(0));
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const vec3 local = frame.toLocal(cubeTexelDirection(face, x, y, size));
                if (!visibility[size_t(cubeTexelIndex(face, x, y, size))] || local.z <= 0) continue;
                const int texel = cubeTexelIndex(face, x / children, y / children, faceSize);
                expected[size_t(texel)] += lookupMap(brdf.lightMaps.data(), 16, brdf.mapping, local) *
                                           local.z * cubeTexelSolidAngle(x, y, size);
            }
    const auto finest = transportVector(visibility, size, faceSize, children * children, brdf, 0, frame);
    CHECK(relativeDistance(finest, expected) < 1e-6);
    const double four =
        relativeDistance(transportVector(visibility, size, faceSize, 4, brdf, 0, frame), expected);
    const double one =
        relativeDistance(transportVector(visibility, size, faceSize, 1, brdf, 0, frame), expected);
    CHECK(four < one);
    CHECK(one < 0.05);
}

TEST_CASE("haar faces: each face keeps its energy") {
    const int faceSize = 16;
    const size_t texels = 16 * 16;
    const std::vector<vec3> values = randomValues(6 * texels, 3);
    std::vector<vec3> transformed = values;
    haarForwardFaces(transformed, faceSize);
    for (size_t face = 0; face < 6; face++) {
        double before = 0, after = 0;
        for (size_t i = face * texels; i < (face + 1) * texels; i++) {
            before += double(glm::dot(values[i], values[i]));
            after += double(glm::dot(transformed[i], transformed[i]));
        }
        CHECK(after == doctest::Approx(before).epsilon(1e-6));
        CHECK(glm::length(transformed[face * texels] - values[face * texels]) > 1e-3f);
    }
}

TEST_CASE("selection: the largest, ties to the lower index, never a zero") {
    const std::vector<vec3> values = {{1, 0, 0}, {0, 0, 0}, {0, -2, 0}, {0, 0, 1}, {0, 1, 0}, {-2, 0, 0}};
    using Indices = std::vector<uint16_t>;
    CHECK(selectLargest(values, 0) == Indices{});
    CHECK(selectLargest(values, 1) == Indices{2});
    CHECK(selectLargest(values, 2) == Indices{2, 5});
    CHECK(selectLargest(values, 3) == Indices{0, 2, 5});
    CHECK(selectLargest(values, 4) == Indices{0, 2, 3, 5});
    CHECK(selectLargest(values, 100) == Indices{0, 2, 3, 4, 5});
    CHECK(selectLargest(std::vector<vec3>(10, vec3(0)), 3).empty());
    CHECK(selectLargest({vec3(std::numeric_limits<float>::quiet_NaN()), vec3(1)}, 2) == Indices{1});
}

TEST_CASE("selection: as by a stable sort of everything") {
    std::vector<vec3> values = randomValues(6 * 32 * 32, 4);
    for (vec3& value : values) value = glm::round(3.0f * value); // many ties, some zeros
    std::vector<uint16_t> order(values.size());
    std::iota(order.begin(), order.end(), uint16_t(0));
    std::stable_sort(order.begin(), order.end(), [&](uint16_t a, uint16_t b) {
        return glm::dot(values[a], values[a]) > glm::dot(values[b], values[b]);
    });
    for (int count : {1, 96, 1000}) {
        std::vector<uint16_t> expected(order.begin(), order.begin() + count);
        std::sort(expected.begin(), expected.end());
        CHECK(selectLargest(values, count) == expected);
    }
}

TEST_CASE("packing: within half a step of each channel, zeros dropped") {
    std::vector<vec3> values = randomValues(512, 5);
    for (size_t i = 0; i < values.size(); i += 2) values[i] *= 1e-4f; // below half a step of all channels
    std::vector<uint16_t> all(values.size());
    std::iota(all.begin(), all.end(), uint16_t(0));
    const PackedRow row = packRow(values, all);
    float largest = 0;
    for (const vec3& v : values) largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    CHECK(row.scale == largest);
    REQUIRE(row.indices.size() == row.values.size());
    CHECK(row.indices.size() == 256);
    const vec3 step = vec3(row.scale) / vec3(kRedMaximum, kGreenMaximum, kBlueMaximum);
    int outside = 0;
    for (size_t i = 0; i < row.indices.size(); i++) {
        CHECK(row.indices[i] % 2 == 1);
        const vec3 error = glm::abs(vec3(unpackCoefficient(row.values[i])) * step - values[row.indices[i]]);
        outside += glm::any(glm::greaterThan(error, 0.5001f * step));
    }
    CHECK(outside == 0);
}

TEST_CASE("packing: a row of zeros or nothing is empty with scale 0") {
    const std::vector<vec3> zeros(4, vec3(0));
    for (const std::vector<uint16_t>& selected : {std::vector<uint16_t>{}, std::vector<uint16_t>{1, 2}}) {
        const PackedRow row = packRow(zeros, selected);
        CHECK(row.scale == 0);
        CHECK(row.indices.empty());
        CHECK(row.values.empty());
    }
}

TEST_CASE("relight: the dot product, to the error that quantization allows") {
    const int faceSize = 8, texels = 6 * faceSize * faceSize;
    LightVector light;
    light.faceSize = faceSize;
    light.scale = 2.0f / kLightMaximum;
    std::vector<glm::dvec3> lightValues(texels, glm::dvec3(0));
    const std::vector<vec3> lightSource = randomValues(texels, 6);
    for (int i = 0; i < texels; i += 3) {
        const ivec3 q(lightSource[size_t(i)] * float(kLightMaximum));
        light.indices.push_back(uint16_t(i));
        light.values.push_back({int16_t(q.x), int16_t(q.y), int16_t(q.z)});
        lightValues[size_t(i)] = glm::dvec3(q) * double(light.scale);
    }

    SparseTransport transport;
    transport.vertices = 3;
    transport.terms = 2;
    transport.rowStarts = {0};
    std::vector<glm::dvec3> expected;
    std::vector<double> allowed; // half a blue step, the coarsest, for each coefficient
    for (unsigned r = 0; r < 6; r++) {
        const std::vector<vec3> coefficients = randomValues(texels, 10 + r);
        const std::vector<uint16_t> selected = selectLargest(coefficients, 20 * int(r)); // row 0 is empty
        const PackedRow row = packRow(coefficients, selected);
        transport.indices.insert(transport.indices.end(), row.indices.begin(), row.indices.end());
        transport.values.insert(transport.values.end(), row.values.begin(), row.values.end());
        transport.scales.push_back(row.scale);
        transport.rowStarts.push_back(transport.values.size());
        expected.emplace_back(0);
        allowed.push_back(1e-9);
        for (uint16_t i : selected) {
            expected.back() += glm::dvec3(coefficients[i]) * lightValues[i];
            allowed.back() += 0.51 * double(row.scale) / kBlueMaximum * glm::length(lightValues[i]);
        }
    }

    const std::vector<vec3> tuples = relight(transport, light);
    REQUIRE(tuples.size() == 6);
    for (size_t r = 0; r < 6; r++) {
        CHECK(glm::length(glm::dvec3(tuples[r]) - expected[r]) < allowed[r]);
        if (r > 0) CHECK(glm::length(expected[r]) > 0.1);
    }
    CHECK(tuples[0] == vec3(0));
}
