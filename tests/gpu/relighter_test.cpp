#include "engine/render/relighter.h"
#include "precompute/twins/relight_twin.h"
#include "precompute/twins/transport_twin.h"
#include "tests/support/asset_sample.h"
#include "tests/support/test_device.h"

#include <doctest/doctest.h>
#include <random>

using namespace relume;

namespace {

// Rows of random length up to `longest`, some empty, with random indices and all 32 bits of values random.
AssetPart makePart(uint32_t vertices, uint32_t terms, uint32_t longest, int faceSize, uint32_t seed) {
    std::mt19937 random(seed);
    AssetPart part;
    part.name = "random";
    part.sets.emplace_back().materials = {{"test", "{}"}};
    SparseTransport& transport = rowsOf(part.sets[0].transport);
    transport.vertices = vertices;
    transport.terms = terms;
    transport.rowStarts.push_back(0);
    for (size_t row = 0; row < transport.rows(); row++) {
        const uint32_t length = random() % 5 == 0 ? 0 : random() % (longest + 1);
        for (uint32_t e = 0; e < length; e++) {
            transport.indices.push_back(uint16_t(random() % uint32_t(6 * faceSize * faceSize)));
            transport.values.push_back(random());
        }
        transport.rowStarts.push_back(transport.values.size());
        transport.scales.push_back(float(1 + random() % 1000) * 0.001f);
    }
    return part;
}

LightCube makeNoise(int size) {
    std::mt19937 random(3);
    LightCube cube{size, {}};
    for (int i = 0; i < 6 * size * size; i++)
        cube.radiance.emplace_back(float(random() % 997), float(random() % 1009), float(random() % 1013));
    return cube;
}

void checkBits(const vk::Device& device, const Asset& asset, const RelighterOptions& options,
               const std::vector<size_t>& shards = {}) {
    Relighter relighter(device, asset, options);
    REQUIRE_EQ(relighter.parts(), asset.parts.size());
    LightPass light(device, asset.faceSize);
    light.setCube(makeNoise(asset.faceSize));
    vk::Commands commands(device, "relight test");
    for (const int threshold : {0, 200}) { // the second over the first's tuples
        commands.begin();
        light.record(commands, 0, {threshold});
        relighter.record(commands, light);
        commands.submitAndWait();
        const LightVector vector = light.readVector();
        REQUIRE_FALSE(vector.indices.empty());
        for (size_t part = 0; part < asset.parts.size(); part++)
            CHECK(relighter.readTuples(part) == relight(asset.parts[part].sets[0].transport, vector));
    }
    for (size_t part = 0; part < shards.size(); part++) CHECK_EQ(relighter.shards(part), shards[part]);
}

} // namespace

TEST_CASE("relighter: every K gives the reference's bits") {
    const TestDevice device;
    Asset asset;
    for (uint32_t terms = 1; terms <= 32; terms++)
        asset.parts.push_back(makePart(37, terms, 50, asset.faceSize, terms));
    checkBits(device, asset, {});
}

TEST_CASE("relighter: faces of 32 and long rows give the reference's bits") {
    const TestDevice device;
    Asset asset;
    asset.faceSize = 32;
    asset.parts.push_back(makePart(40, 2, 6 * 32 * 32, asset.faceSize, 1));
    checkBits(device, asset, {});
}

TEST_CASE("relighter: shards give the reference's bits") {
    const TestDevice device;
    Asset asset;
    asset.parts.push_back(makePart(100, 4, 96, asset.faceSize, 1));
    asset.parts.push_back(makePart(10, 1, 0, asset.faceSize, 2)); // empty rows only
    asset.parts.push_back(makePart(0, 3, 0, asset.faceSize, 3));  // no rows at all
    checkBits(device, asset, {}, {1, 1, 0});

    // A shard a row, whatever its length.
    checkBits(device, asset, {.largestShard = 1}, {400, 10, 0});

    size_t groups = 0;
    const SparseTransport& transport = rowsOf(asset.parts[0].sets[0].transport);
    for (size_t row = 0; row < transport.rows(); row++)
        groups += (transport.rowStarts[row + 1] - transport.rowStarts[row] + 7) / 8;
    Relighter relighter(device, asset, {.largestShard = 48 * groups / 4});
    CHECK_LE(4, relighter.shards(0));
    CHECK_LE(relighter.shards(0), 6);
    checkBits(device, asset, {.largestShard = 48 * groups / 4});
}

TEST_CASE("relighter: tuples of sums that reach the limits of 32 bits are exact") {
    const TestDevice device;
    // Every coefficient is there with the largest magnitude, of the sign that its light has.
    Asset asset;
    LightPass light(device, 64);
    std::mt19937 random(5);
    LightCube cube{64, {}};
    for (int i = 0; i < 6 * 64 * 64; i++) cube.radiance.emplace_back(float(int(random() % 2001) - 1000));
    light.setCube(cube);
    vk::Commands commands(device, "relight test");
    commands.begin();
    light.record(commands, 0, {0});
    commands.submitAndWait();
    const LightVector vector = light.readVector();

    AssetPart& part = asset.parts.emplace_back();
    part.sets.emplace_back();
    rowsOf(part.sets[0].transport).vertices = rowsOf(part.sets[0].transport).terms = 1;
    rowsOf(part.sets[0].transport).scales = {1};
    int64_t expected = 0;
    for (size_t e = 0; e < vector.indices.size(); e++) {
        const int sign = vector.values[e][0] < 0 ? -1 : 1;
        rowsOf(part.sets[0].transport).indices.push_back(vector.indices[e]);
        rowsOf(part.sets[0].transport)
            .values.push_back(packCoefficient(ivec3(1023 * sign, 1023 * sign, 511 * sign)));
        expected += 1023 * int64_t(std::abs(vector.values[e][0]));
    }
    rowsOf(part.sets[0].transport).rowStarts = {0, rowsOf(part.sets[0].transport).values.size()};
    Relighter relighter(device, asset);
    commands.begin();
    relighter.record(commands, light);
    commands.submitAndWait();
    const vec3 tuple = relighter.readTuples(0)[0];
    CHECK_LT(int64_t(1) << 30, expected); // close enough to the limit to mean something
    CHECK_EQ(int64_t(relightSums(rowsOf(part.sets[0].transport), vector)[0].x), expected);
    CHECK(relight(part.sets[0].transport, vector)[0] == tuple);
}

TEST_CASE("relighter: bases give the reference's bits") {
    const TestDevice device;
    std::mt19937 random(12);
    Asset asset;
    const auto add = [&](uint32_t vertices, uint32_t terms, uint32_t columns) {
        AssetPart& part = asset.parts.emplace_back();
        part.sets.emplace_back().transport =
            test::sampleBases(vertices, terms, asset.faceSize, columns, random);
    };
    for (uint32_t terms = 1; terms <= 32; terms += 5) add(300, terms, 90);
    add(256, 2, 4000);
    add(1, 1, 100);
    add(2000, 4, 300);
    add(40, 2, 0);
    checkBits(device, asset, {});
    checkBits(device, asset, {.largestShard = 1});
    checkBits(device, asset, {.largestShard = 64 * 1024});
}
