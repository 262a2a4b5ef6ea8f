#include "engine/transport/bases/basis_transport.h"

#include "engine/chunk/block_chunk.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

size_t BasisTransport::entries() const {
    size_t columns = 0;
    for (const BasisCluster& cluster : clusters) columns += cluster.columns();
    return columns;
}

uint64_t BasisTransport::bytes() const {
    uint64_t sum = 0;
    for (const BasisCluster& cluster : clusters)
        sum += cluster.indices.size() * sizeof(uint16_t) + cluster.basis.size() +
               cluster.counts.size() * sizeof(uint16_t) + cluster.scales.size() * sizeof(float) +
               cluster.weights.size();
    return sum;
}

void BasisTransport::dequantizeRow(size_t row, std::span<vec3> coefficients) const {
    const size_t vertex = row / terms, term = row % terms;
    const size_t number = vertex / kBasisVertices, own = vertex % kBasisVertices;
    const BasisCluster& cluster = clusters[number];
    size_t scale = 0, weight = 0; // where the kind's entries begin
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        const size_t count = cluster.counts[kind];
        if (kinds[kind].term == term)
            for (size_t column = 0; column < cluster.columns(); column++) {
                float sum = 0;
                for (size_t i = 0; i < count; i++)
                    sum += cluster.scales[scale + i] * float(cluster.weights[weight + own * count + i]) *
                           float(cluster.basis[column * cluster.components + i]);
                coefficients[cluster.indices[column]] += kinds[kind].color * sum;
            }
        scale += count;
        weight += count * verticesOf(number);
    }
}

void checkLayout(const BasisTransport& layout, const std::string& where) {
    expect(layout.kinds.size() <= 3 * size_t(layout.terms), where, "at most three kinds a term");
    uint32_t term = 0, ofTerm = 0;
    for (const BasisKind& kind : layout.kinds) {
        expect(kind.term >= term && kind.term < layout.terms, where, "kinds by rising term");
        ofTerm = kind.term == term ? ofTerm + 1 : 1;
        term = kind.term;
        expect(ofTerm <= 3, where, "at most three kinds a term");
        for (int channel = 0; channel < 3; channel++)
            expect(std::isfinite(kind.color[channel]), where, "finite colors of kinds");
    }
}

void checkCluster(const BasisCluster& cluster, size_t vertices, size_t kinds, uint32_t coefficients,
                  const std::string& where) {
    expect(cluster.components <= kMostBasisComponents && cluster.columns() <= kMostBasisColumns, where,
           "no more columns and components than a cluster may have");
    expectCount(cluster.basis.size(), cluster.columns() * cluster.components, where, "basis values");
    expectCount(cluster.counts.size(), kinds, where, "counts of weights");
    size_t scales = 0;
    for (const uint16_t count : cluster.counts) {
        expect(count <= cluster.components, where, "no more weights than components");
        scales += count;
    }
    expectCount(cluster.scales.size(), scales, where, "weight scales");
    expectCount(cluster.weights.size(), scales * vertices, where, "weights");
    expect(std::ranges::all_of(cluster.scales, isMagnitude), where,
           "weight scales that are finite and not negative");
    const auto isSmall = [](int8_t value) { return value >= -kBasisMaximum; };
    expect(std::ranges::all_of(cluster.basis, isSmall) && std::ranges::all_of(cluster.weights, isSmall),
           where, "basis values and weights within ±127");
    checkIndices(cluster.indices, coefficients, [&] { return where; });
}

void checkTransport(const BasisTransport& transport, uint32_t coefficients, uint64_t,
                    const std::string& where) {
    checkLayout(transport, where);
    expectCount(transport.clusters.size(), transport.clusterCount(), where, "clusters");
    for (size_t number = 0; number < transport.clusters.size(); number++)
        checkCluster(transport.clusters[number], transport.verticesOf(number), transport.kinds.size(),
                     coefficients, fmt::format("{}: cluster {}", where, number));
}

} // namespace relume
