// Tests what must hold in every asset: one that breaks it could not be read back, and is not written.
#include "engine/transport/asset_check.h"
#include "tests/support/asset_sample.h"
#include "tests/support/failure.h"

#include <doctest/doctest.h>
#include <functional>
#include <limits>

using namespace relume;
using namespace relume::test;

TEST_CASE("asset file: an asset that could not be read back is not written") {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    const auto refuses = [](const std::function<void(Asset&)>& change) {
        Asset asset = sampleAsset();
        change(asset);
        CHECK_THROWS_AS(encodeAsset(asset), Error);
    };
    refuses([](Asset& a) { a.parts.clear(); });
    refuses([](Asset& a) { a.faceSize = 16, a.visibilitySize = 8; });
    refuses([&](Asset& a) { a.visibilityOffset = nan; });
    refuses([](Asset& a) { a.occluder.triangles[3].y = 19; });
    refuses([&](Asset& a) { a.occluder.positions[3].y = infinite; });
    refuses([](Asset& a) { a.parts[0].mesh.triangles.clear(); });
    refuses([](Asset& a) { a.parts[0].mesh.normals.pop_back(); });
    refuses([](Asset& a) { a.parts[0].mesh.normals[2] *= 1.01f; });
    refuses([&](Asset& a) { a.parts[0].mesh.normals[2].x = nan; });
    refuses([&](Asset& a) { a.parts[0].sets[0].brdf.lightMaps[5].z = nan; });
    refuses([](Asset& a) { a.parts[0].sets[0].brdf.viewMaps.pop_back(); });
    refuses([&](Asset& a) { a.parts[0].sets[0].brdf.eigenvalues[0][1] = infinite; });
    refuses([](Asset& a) { a.parts[0].sets[0].brdf.mapping = DiskMapping(4); });
    refuses([](Asset& a) { a.parts[0].sets.clear(); });
    refuses([](Asset& a) { a.parts[0].sets[0].materials.clear(); });
    refuses([](Asset& a) { a.parts[0].sets[0].materials[1].layer = 0; });
    refuses([](Asset& a) { a.parts[0].sets[0].materials.pop_back(); }); // two layers of nobody
    refuses([](Asset& a) { a.parts[0].sets[0].materials[0].name = "a\x1b[2J"; });
    refuses([](Asset& a) { a.parts[0].baseColor.reset(); });
    refuses([](Asset& a) { a.parts[0].baseColor->texels.pop_back(); });
    refuses([&](Asset& a) { a.parts[0].mesh.uvs[3].x = nan; });
    refuses([](Asset& a) { a.parts[0].mesh.uvs.pop_back(); });
    refuses([](Asset& a) { a.parts[1].mesh.colors[2].y = 1.5f; });
    refuses([](Asset& a) { a.parts[1].mesh.tangents.pop_back(); });
    refuses([](Asset& a) { a.parts[1].mesh.tangents[3] *= 1.01f; });
    refuses([](Asset& a) { a.parts[1].mesh.tangents[3] = a.parts[1].mesh.normals[3]; });
    refuses([&](Asset& a) { a.parts[1].mesh.tangents[3].x = nan; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).terms = 2; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).vertices = 18; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).rowStarts[1] = 1000000; });
    refuses([](Asset& a) {
        std::swap(rowsOf(a.parts[0].sets[0].transport).rowStarts[1],
                  rowsOf(a.parts[0].sets[0].transport).rowStarts[2]);
    });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).rowStarts.pop_back(); });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).scales[0] = -1; });
    refuses([](Asset& a) {
        rowsOf(a.parts[0].sets[0].transport).indices[1] = rowsOf(a.parts[0].sets[0].transport).indices[0];
    });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).indices.back() = 384; });
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).values[0] = 0x400; });       // red -1024
    refuses([](Asset& a) { rowsOf(a.parts[0].sets[0].transport).values[0] = 0x80000000u; }); // blue -512
}

TEST_CASE("asset file: numbers and paint that make no sense are not written, and named") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto refuses = [](const char* said, const std::function<void(Asset&)>& change) {
        Asset asset = sampleAsset();
        change(asset);
        const std::string failure = failureOf([&] { encodeAsset(asset); });
        CAPTURE(failure);
        CHECK(says(failure, said));
    };
    for (const float wrong : {-0.5f, nan, std::numeric_limits<float>::infinity()}) {
        refuses("an offset and errors", [&](Asset& a) { a.visibilityOffset = wrong; });
        refuses("an offset and errors", [&](Asset& a) { a.quantizationError = wrong; });
        refuses("an offset and errors", [&](Asset& a) { a.truncationError = wrong; });
    }
    for (const float wrong : {-0.01f, 1.01f, nan})
        refuses("a share of baked vertices", [&](Asset& a) { a.provenance.bakedShare = wrong; });
    for (const float wrong : {-100.1f, 100.1f, nan})
        refuses("a scale of normals", [&](Asset& a) { a.parts[0].detail.normalScale = wrong; });
    for (const float wrong : {-0.01f, 1.1e6f, nan})
        refuses("an emission", [&](Asset& a) { a.parts[0].detail.emission.z = wrong; });
    refuses("finite light and view maps", [&](Asset& a) { a.parts[0].sets[0].brdf.viewMaps[3].y = nan; });
    refuses("texture coordinates for its textures", [](Asset& a) { a.parts[0].mesh.uvs.clear(); });
    refuses("vertex colors that do not paint", [](Asset& a) { a.parts[0].tintedByColors = true; });
    refuses("shares of direct light only where light bounces",
            [](Asset& a) { a.parts[0].sets[0].directShares.resize(1); });
    refuses("words of shares of direct light", [](Asset& a) {
        a.bounces = 1;
        a.parts[0].sets[0].directShares.resize(1);
    });
}
