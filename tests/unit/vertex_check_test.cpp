// Tests that a vertex recomputed from an asset matches the row that the same stages stored, and no other.
#include "engine/math/haar.h"
#include "precompute/twins/vertex_check.h"

#include "engine/import/builtin_mesh.h"
#include "engine/math/cubemap.h"
#include "tests/support/diffuse_asset.h"

#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;

namespace {

// A torus with two terms, baked vertex by vertex from the stages themselves.
Asset bakeTorus(const RayTracer& tracer, const Mesh& torus) {
    AssetPart part = makeDiffusePart(torus, 0.5f);
    part.sets[0].brdf.terms = 2;
    for (size_t i = 0; i < part.sets[0].brdf.mapTexels(); i++)
        part.sets[0].brdf.lightMaps.push_back(vec3(float(i % 8), 1, -float(i / 8)));
    Asset asset = makeTestAsset({part});
    asset.visibilitySize = 32, asset.faceSize = 16, asset.coefficients = 20, asset.transportSamples = 4;

    SparseTransport& transport = rowsOf(asset.parts[0].sets[0].transport);
    transport.vertices = uint32_t(torus.vertexCount());
    transport.terms = 2;
    transport.rowStarts = {0};
    for (size_t vertex = 0; vertex < torus.vertexCount(); vertex++) {
        const vec3 n = torus.normals[vertex];
        const auto visibility =
            visibilityCube(tracer, torus.positions[vertex] + asset.visibilityOffset * n, n, 32);
        for (int term = 0; term < 2; term++) {
            auto cube = transportVector(visibility, 32, 16, 4, part.sets[0].brdf, term, tangentFrame(n));
            haarForwardFaces(cube, 16);
            const PackedRow row = packRow(cube, selectLargest(cube, 20));
            transport.indices.insert(transport.indices.end(), row.indices.begin(), row.indices.end());
            transport.values.insert(transport.values.end(), row.values.begin(), row.values.end());
            transport.scales.push_back(row.scale);
            transport.rowStarts.push_back(transport.values.size());
        }
    }
    return asset;
}

bool isSameRow(const PackedRow& a, const PackedRow& b) {
    return a.scale == b.scale && a.indices == b.indices && a.values == b.values;
}

} // namespace

TEST_CASE("vertex check: recomputes exactly what the stages stored") {
    const Mesh torus = makeTorus(1.0f, 0.4f, 12, 8);
    const Mesh* occluders[] = {&torus};
    const RayTracer tracer{occluders};
    const Asset asset = bakeTorus(tracer, torus);
    for (size_t vertex = 0; vertex < torus.vertexCount(); vertex += 7) {
        const VertexReference reference = recomputeVertex(asset, 0, 0, vertex, tracer);
        CHECK(reference.visibility.size() == 6 * 32 * 32);
        REQUIRE(reference.terms.size() == 2);
        for (size_t term = 0; term < 2; term++) {
            const TermReference& recomputed = reference.terms[term];
            CHECK(recomputed.selected.size() == 20);
            CHECK(
                isSameRow(recomputed.row, storedRow(rowsOf(asset.parts[0].sets[0].transport), vertex, term)));
            CHECK_FALSE(isSameRow(recomputed.row,
                                  storedRow(rowsOf(asset.parts[0].sets[0].transport), vertex, 1 - term)));
            std::vector<vec3> transformed = recomputed.transport;
            haarForwardFaces(transformed, 16);
            CHECK(transformed == recomputed.coefficients);
        }
    }
}
