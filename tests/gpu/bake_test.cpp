// The whole bake on a small scene, verified stage by stage.
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "precompute/bake/bake.h"
#include "precompute/layout/conversion.h"
#include "precompute/twins/verification.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numeric>

using namespace relume;
using relume::test::TemporaryFolder;

namespace {

Scene smallScene(const std::string& material) {
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(400), material, "built-in knot", ""});
    addGround(scene, {.tessellation = 6}, "white-diffuse");
    return scene;
}

} // namespace

TEST_CASE("bake: every stage agrees with its CPU twin and Embree") {
    const TestDevice device;
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.coefficients = defaultCoefficients(TransportLayout::Rows);
    options.factorization.terms =
        5; // with batches of 64 vertices, more than a row for each lane of row_starts.comp
    const Asset asset = bake(device, smallScene("ashikhmin-shirley"), options);
    CHECK_EQ(asset.parts[0].sets[0].brdf.terms, 5);
    CHECK_EQ(asset.parts[1].sets[0].brdf.terms, 1); // diffuse: one term is exact
    const Verification found = verify(device, asset, prepareForSampling(makeSky()), 0.3f, 40);
    CHECK_LE(found.visibilityMismatch, 0.005);
    CHECK_LE(found.transportError, 1e-4);
    CHECK_EQ(found.relightBits, 0u);
    REQUIRE(found.rows);
    CHECK_LE(found.rows->quantization, 0.01);
    CHECK_GT(found.rows->wavelet, 0.02);
    CHECK_LT(found.rows->wavelet, 0.35);
    CHECK_LT(found.totalError, 0.4);
    // The bake's own sums over all vertices say about the same as the sample.
    CHECK(asset.truncationError == doctest::Approx(found.rows->wavelet).epsilon(0.3));
}

TEST_CASE("bake: the same scene gives the same bytes") {
    const TestDevice device;
    BakeOptions options;
    options.visibilitySize = 64;
    options.mapSize = 24;
    options.coefficients = 32;
    const std::vector<std::byte> once = encodeAsset(bake(device, smallScene("clay"), options));
    CHECK(encodeAsset(bake(device, smallScene("clay"), options)) == once);
}

TEST_CASE("bake: a file baked block by block has the bytes of the asset baked in memory, read or not") {
    const TestDevice device;
    const TemporaryFolder folder;
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.mapSize = 24;
    options.coefficients = 1500; // blocks of 32 vertices
    options.factorization.terms = 16;
    const std::vector<std::byte> whole = encodeAsset(bake(device, smallScene("ashikhmin-shirley"), options));
    BakeObserver silent;
    const auto path = folder.path() / "a.relume";
    const BakeSummary summary =
        bakeToFile(device, smallScene("ashikhmin-shirley"), options, path, {.memory = 4 << 20}, silent);
    CHECK_EQ(summary.resumed, 0u);
    CHECK_LT(summary.times.batch, 32u);
    CHECK(readFile(path) == whole);
    CHECK(encodeAsset(readAsset(path)) == whole);
    CHECK_FALSE(std::filesystem::exists(checkpointPath(path)));
}

TEST_CASE("bake: bases of one term are made from four times as many entries") {
    const TestDevice device;
    BakeOptions options;
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.mapSize = 24;
    options.factorization.terms = 2;
    const auto truncation = [&](const char* material, TransportLayout layout, int coefficients) {
        Scene scene;
        scene.parts.push_back({"knot", makeKnot(400), material, "built-in knot", ""});
        options.layout = {.layout = layout};
        options.coefficients = coefficients;
        const Asset asset = bake(device, scene, options);
        CHECK_EQ(asset.coefficients, coefficients);
        return asset.truncationError;
    };
    using enum TransportLayout;
    CHECK_EQ(truncation("white-diffuse", Bases, 32), truncation("white-diffuse", Rows, 128));
    CHECK_EQ(truncation("gold", Bases, 32), truncation("gold", Rows, 32));
    CHECK_LT(truncation("white-diffuse", Bases, 6 * 32 * 32), 1e-6f); // never more than all
}

TEST_CASE("bake: bases of one term that are converted to bases keep their entries") {
    const TestDevice device;
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(400), "white-diffuse", "built-in knot", ""});
    BakeOptions options;
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.coefficients = 32;
    options.layout.error = 0.01;
    Asset asset = bake(device, scene, options);
    const Transport before = asset.parts[0].sets[0].transport;
    convertLayout(asset, {.error = 0.001});
    const Transport& after = asset.parts[0].sets[0].transport;
    double lost = 0, lostByN = 0, all = 0; // squared: by the conversion, by rows of N
    for (size_t row = 0; row < verticesOf(before); row++) {
        const std::vector<vec3> expected = dequantizedRow(before, row, 6 * 32 * 32),
                                found = dequantizedRow(after, row, 6 * 32 * 32);
        std::vector<double> squares;
        for (size_t i = 0; i < expected.size(); i++) {
            const vec3 difference = found[i] - expected[i];
            lost += double(glm::dot(difference, difference));
            squares.push_back(double(glm::dot(expected[i], expected[i])));
        }
        std::ranges::sort(squares);
        all = std::accumulate(squares.begin(), squares.end(), all);
        lostByN = std::accumulate(squares.begin(), squares.end() - options.coefficients, lostByN);
    }
    MESSAGE("lost ", std::sqrt(lost / all), ", by rows of N ", std::sqrt(lostByN / all));
    CHECK_LT(lost, 0.25 * lostByN);
}

TEST_CASE("bake: bases are as good as a conversion of the rows, block by block or not") {
    const TestDevice device;
    const TemporaryFolder folder;
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(1100), "gold", "built-in knot", ""});
    addGround(scene, {.tessellation = 24}, "white-diffuse");
    BakeOptions options;
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.mapSize = 24;
    options.factorization.terms = 2;
    options.coefficients = 200;
    options.layout = {.layout = TransportLayout::Rows};
    Asset rows = bake(device, scene, options);
    options.coefficients *= 4; // as bases of one term are made from
    rows.coefficients = options.coefficients;
    rows.parts[1] = bake(device, scene, options).parts[1];
    options.coefficients /= 4;
    BakeObserver silent;
    for (const LayoutOptions& layout : {LayoutOptions{.error = 0.05}, LayoutOptions{.bytesPerVertex = 120}}) {
        Asset converted = rows;
        const Conversion conversion = convertLayout(converted, layout);
        options.layout = layout;
        const auto path = folder.path() / "a.relume";
        const BakeSummary summary = bakeToFile(device, scene, options, path, {.memory = 16 << 20}, silent);
        const Asset baked = readAsset(path);
        CHECK_LT(summary.times.batch, scene.parts[0].mesh.vertexCount());
        CHECK(encodeAsset(bake(device, scene, options)) == readFile(path));
        REQUIRE(baked.layout);
        REQUIRE(summary.layout);
        CHECK_EQ(summary.layout->error, baked.layout->error);
        CHECK(baked.layout->wantedBytes == layout.bytesPerVertex);
        uint64_t bytes = 0;
        for (const AssetPart& part : baked.parts) {
            CHECK(layoutOf(part.sets[0].transport) == layout.layout);
            bytes += bytesOf(part.sets[0].transport);
        }
        CHECK_EQ(summary.bytes, bytes);
        // A sample of few clusters misses what was asked for; what came of it is as good as anything.
        CHECK(baked.layout->error == doctest::Approx(*conversion.error).epsilon(0.25));
        Asset same = rows;
        const Conversion exact = convertLayout(same, {.layout = layout.layout, .error = baked.layout->error});
        MESSAGE("bytes ", bytes, ", converted ", exact.bytesAfter, "; error ", baked.layout->error,
                ", converted ", *conversion.error);
        CHECK(double(bytes) < 1.05 * double(exact.bytesAfter));
    }
}

TEST_CASE("bake: a simplified occluder, a small cube and progress to the end") {
    const TestDevice device;
    BakeOptions options;
    options.faceSize = 32;
    options.visibilitySize = 64;
    options.occluderTriangles = 200;
    struct Last : BakeObserver {
        BakeStatus status;
        void progress(const BakeStatus& now) override { status = now; }
    } last;
    const Asset asset = bake(device, smallScene("red-plastic"), options, last);
    CHECK_LE(asset.occluder.triangleCount(), 220u);
    CHECK_EQ(last.status.done, asset.parts[0].mesh.vertexCount() + asset.parts[1].mesh.vertexCount());
    CHECK_EQ(last.status.vertices, last.status.done);
    CHECK_EQ(last.status.fraction, 1);
    const Verification found = verify(device, asset, prepareForSampling(makeSky()), 0, 20);
    CHECK_LE(found.transportError, 1e-4);
    CHECK_FALSE(found.rows); // but bases
    CHECK_EQ(found.relightBits, 0u);
}
