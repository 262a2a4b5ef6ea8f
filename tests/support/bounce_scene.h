// A small scene with bounced light, in terms and colors that cannot be mistaken for each other.
#pragma once

#include "engine/import/builtin_mesh.h"
#include "engine/transport/rows/sparse_transport.h"
#include "precompute/bounce/bounce_gather.h"
#include "precompute/transport/row_sum.h"
#include "tests/support/diffuse_asset.h"

#include <random>

namespace relume::test {

// Returns a BRDF of `count` terms, whose maps differ by term, channel and direction.
inline FactoredBrdf coloredTerms(int count) {
    FactoredBrdf brdf = makeDiffuseFactors({0.2f, 0.1f, 0.05f});
    for (; brdf.terms < count; brdf.terms++) {
        const float term = float(brdf.terms) / float(count);
        brdf.eigenvalues.push_back(brdf.eigenvalues[0]);
        for (size_t i = 0; i < brdf.mapTexels(); i++) {
            const float x = float(i % 8) / 8, y = float(i / 8) / 8;
            brdf.lightMaps.push_back({term * x, 0.5f, (1 - term) * y});
            brdf.viewMaps.push_back(vec3(y, (1 - term) * x, term) / (8 * kPi));
        }
    }
    return brdf;
}

// Returns rows of random positive values in the first `coefficients` coefficients.
inline SparseTransport randomRows(const AssetPart& part, std::mt19937& random, int coefficients = 8) {
    SparseTransport rows = emptyRows(uint32_t(part.sets[0].brdf.terms));
    RowSum sum(kBounceCoefficients);
    std::uniform_real_distribution<float> amount(0.5f, 1);
    for (size_t row = 0; row < part.mesh.vertexCount() * rows.terms; row++) {
        for (int i = 0; i < coefficients; i++)
            sum.add(size_t(i), {amount(random), amount(random), amount(random)});
        appendRow(rows, sum.pack(coefficients));
    }
    rows.vertices = uint32_t(part.mesh.vertexCount());
    return rows;
}

// Returns a torus of around · across vertices on a ground. The torus has two sets, of more terms than are
// summed side by side.
inline Asset makeBounceScene(int around = 24, int across = 12) {
    Mesh ground = makePlane(4, 4);
    for (vec3& position : ground.positions) position.y -= 0.5f;
    Asset asset = makeTestAsset(
        {makeDiffusePart(makeTorus(1, 0.4f, around, across), 0.5f), makeDiffusePart(ground, 0.5f)});
    MaterialSet second = asset.parts[0].sets[0];
    asset.parts[0].sets[0].brdf = coloredTerms(3);
    second.brdf = coloredTerms(13);
    asset.parts[0].sets.push_back(second);
    return asset;
}

// Returns all coefficients of a row.
inline std::vector<vec3> denseRow(const SparseTransport& rows, size_t row) {
    std::vector<vec3> dense(kBounceCoefficients, vec3(0));
    rows.dequantizeRow(row, dense);
    return dense;
}

} // namespace relume::test
