// Previews of a bake: how near they come, and that they leave no trace.
#include "engine/base/file.h"
#include "engine/import/builtin_mesh.h"
#include "engine/import/scene.h"
#include "engine/math/haar.h"
#include "precompute/bake/bake.h"
#include "precompute/bake/preview.h"
#include "precompute/twins/transport_twin.h"
#include "tests/support/capture_binding.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_device.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <numeric>
#include <set>

using namespace relume;
using relume::test::TemporaryFolder;

namespace {

Scene knotOnGround(int vertices = 1800, int tessellation = 19) {
    Scene scene;
    scene.parts.push_back({"knot", makeKnot(vertices), "gold", "built-in knot", ""});
    addGround(scene, {.tessellation = tessellation}, "white-diffuse");
    return scene;
}

BakeOptions smallOptions(TransportLayout layout = TransportLayout::Rows) {
    BakeOptions options;
    options.layout = {.layout = layout};
    options.visibilitySize = 64;
    options.faceSize = 32;
    options.coefficients = 48;
    options.mapSize = 24;
    options.factorization.terms = 2;
    return options;
}

// What a fixed light that changes from side to side makes of every row.
std::vector<vec3> relit(const Asset& asset) {
    std::vector<vec3> light(size_t(6 * asset.faceSize * asset.faceSize));
    for (size_t i = 0; i < light.size(); i++) light[i] = vec3(1 + float(i * 7 / light.size()));
    haarForwardFaces(light, asset.faceSize);
    std::vector<vec3> sums;
    for (const AssetPart& part : asset.parts) {
        const Transport& transport = part.sets[0].transport;
        for (size_t row = 0; row < size_t(verticesOf(transport)) * termsOf(transport); row++) {
            const std::vector<vec3> coefficients = dequantizedRow(transport, row, light.size());
            vec3 sum(0);
            for (size_t i = 0; i < light.size(); i++) sum += coefficients[i] * light[i];
            sums.push_back(sum);
        }
    }
    return sums;
}

// Relative, over all rows.
double errorOf(const std::vector<vec3>& found, const std::vector<vec3>& right) {
    REQUIRE_EQ(found.size(), right.size());
    double wrong = 0, all = 0;
    for (size_t row = 0; row < right.size(); row++) {
        wrong += double(glm::dot(found[row] - right[row], found[row] - right[row]));
        all += double(glm::dot(right[row], right[row]));
    }
    return std::sqrt(wrong / all);
}

struct Seen : BakeObserver {
    explicit Seen(std::filesystem::path file) : path(std::move(file)) {}

    void stage(BakeStage stage, const std::string&) override { now = stage; }
    void progress(const BakeStatus& status) override {
        if (now == BakeStage::Preview) coarseVertices = std::max(coarseVertices, status.vertices);
    }
    void preview(double share) override {
        const Asset asset = readAsset(path);
        REQUIRE(asset.provenance.bakedShare);
        CHECK_EQ(double(*asset.provenance.bakedShare), share);
        shares.push_back(share);
        sums.push_back(relit(asset));
    }
    bool wantsStop() override { return shares.size() >= stopAfter; }

    std::filesystem::path path;
    BakeStage now = BakeStage::Occluder;
    uint64_t coarseVertices = 0;
    size_t stopAfter = 100;
    std::vector<double> shares;
    std::vector<std::vector<vec3>> sums;
};

} // namespace

TEST_CASE("preview: the blocks' portions are all of them once, each over the whole of every part") {
    const TestDevice device;
    BakeObserver silent;
    const BakePlan plan = planBake(device, knotOnGround(), smallOptions(), silent);
    std::vector<uint32_t> blocks(plan.blocks.size());
    std::iota(blocks.begin(), blocks.end(), 0u);
    const auto portions = previewPortions(plan, blocks);
    REQUIRE_EQ(portions.size(), 4);
    std::set<uint32_t> seen;
    for (const auto& portion : portions) {
        std::vector<uint32_t> sorted = portion;
        std::ranges::sort(sorted);
        for (size_t i = 1; i < sorted.size(); i++)
            if (plan.blocks[sorted[i]].part == plan.blocks[sorted[i - 1]].part)
                CHECK_EQ(sorted[i] - sorted[i - 1], 4);
        seen.insert(portion.begin(), portion.end());
    }
    CHECK_EQ(seen.size(), blocks.size());
    CHECK(previewPortions(plan, std::vector<uint32_t>{6}) == std::vector<std::vector<uint32_t>>{{6}});
}

TEST_CASE("preview: near the finished bake, nearer each time, and without a trace in its bytes") {
    const TestDevice device;
    const Scene scene = knotOnGround(2500, 24);
    for (const TransportLayout layout : {TransportLayout::Rows, TransportLayout::Bases}) {
        CAPTURE(layoutName(layout));
        const TemporaryFolder folder;
        const auto path = folder.path() / "a.relume";
        Seen previews(path);
        const BakeOptions options = smallOptions(layout);
        const std::vector<std::byte> whole = encodeAsset(bake(device, scene, options));
        bakeToFile(device, scene, options, path, {}, previews, {.previews = true});
        CHECK(readFile(path) == whole);
        const Asset finished = readAsset(path);
        CHECK_FALSE(finished.provenance.bakedShare);
        const std::vector<vec3> right = relit(finished);
        // A twelfth, rounded up.
        CHECK_GE(previews.coarseVertices, (2500 + 625) / 12);
        CHECK_LE(previews.coarseVertices, (2500 + 625) / 12 + 20);
        // In bases a draft in rows comes first, and the sample is baked before the second preview.
        REQUIRE_EQ(previews.shares.size(), layout == TransportLayout::Rows ? 4 : 5);
        CHECK_EQ(previews.shares[0], 0);
        for (size_t i = 0; i < previews.shares.size(); i++) {
            CAPTURE(i);
            if (layout == TransportLayout::Rows)
                CHECK(previews.shares[i] == doctest::Approx(0.25 * double(i)).epsilon(0.15));
            else if (i > 0)
                CHECK(previews.shares[i] > previews.shares[i - 1]);
            const double error = errorOf(previews.sums[i], right);
            CHECK_GT(error, 0);
            CHECK_LT(error, i == 0 ? 0.16 : 0.95 * errorOf(previews.sums[i - 1], right));
        }
        for (const auto& file : std::filesystem::directory_iterator(folder.path()))
            CHECK_EQ(file.path().filename(), "a.relume");
    }
}

TEST_CASE(
    "preview: where light bounces the draft is of direct light, and interpolated vertices have it all") {
    const TestDevice device;
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.relume";
    Seen previews(path);
    BakeOptions options = smallOptions();
    const std::vector<vec3> direct = relit(bake(device, knotOnGround(), options));
    options.bounces = 2;
    bakeToFile(device, knotOnGround(), options, path, {}, previews, {.previews = true});
    const std::vector<vec3> right = relit(readAsset(path));
    REQUIRE_EQ(previews.shares.size(), 5);
    CHECK_EQ(previews.shares[1], 0);
    CHECK_LT(errorOf(previews.sums[0], direct), errorOf(previews.sums[0], right));
    CHECK_LT(errorOf(previews.sums[1], right), errorOf(previews.sums[1], direct));
}

TEST_CASE("preview: a bake that was stopped goes on from it, with previews or without") {
    const TestDevice device;
    for (const auto& [layout, again] :
         {std::pair(TransportLayout::Rows, true), std::pair(TransportLayout::Bases, false)}) {
        CAPTURE_BINDING(layoutName(layout));
        const BakeOptions options = smallOptions(layout);
        const std::vector<std::byte> whole = encodeAsset(bake(device, knotOnGround(), options));
        const TemporaryFolder folder;
        const auto path = folder.path() / "a.relume";
        Seen stopped(path);
        stopped.stopAfter = layout == TransportLayout::Bases ? 2 : 1;
        CHECK_THROWS_AS(bakeToFile(device, knotOnGround(), options, path, {}, stopped, {.previews = true}),
                        BakeStopped);
        CHECK_GT(stopped.coarseVertices, 0);
        const std::optional<float> share = readAsset(path).provenance.bakedShare;
        REQUIRE(share);
        CHECK((*share > 0) == (layout == TransportLayout::Bases)); // the sample's
        CHECK(*share < 0.7f);
        CHECK(std::filesystem::exists(interpolatedPath(path)));
        Seen resumed(path);
        bakeToFile(device, knotOnGround(), options, path, {}, resumed, {.previews = again});
        CHECK_EQ(resumed.coarseVertices, 0);
        CHECK_EQ(resumed.shares.empty(), !again);
        CHECK(readFile(path) == whole);
        for (const auto& file : std::filesystem::directory_iterator(folder.path()))
            CHECK_EQ(file.path().filename(), "a.relume");
    }
}
