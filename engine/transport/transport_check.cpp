#include "engine/transport/transport_check.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

void expect(bool holds, const std::string& where, const char* what) {
    if (!holds) throw Error(fmt::format("{}: expected {}", where, what));
}

void expectCount(size_t count, size_t expected, const std::string& where, const char* what) {
    if (count != expected)
        throw Error(fmt::format("{}: expected {} {}, found {}", where, expected, what, count));
}

bool isMagnitude(float value) { return std::isfinite(value) && value >= 0; }

bool isWithinMaxima(uint32_t packed) {
    // Only the most negative number of a field lies beyond the negated maximum.
    const ivec3 value = unpackCoefficient(packed);
    return value.x >= -kRedMaximum && value.y >= -kGreenMaximum && value.z >= -kBlueMaximum;
}

} // namespace

void checkTransport(const SparseTransport& transport, uint32_t coefficients, uint64_t longestRow,
                    const std::string& where) {
    expectCount(transport.rowStarts.size(), transport.rows() + 1, where, "row starts");
    expectCount(transport.scales.size(), transport.rows(), where, "scales");
    expectCount(transport.indices.size(), transport.entries(), where, "indices");
    expect(transport.rowStarts.front() == 0 && transport.rowStarts.back() == transport.entries(), where,
           "rows that span all entries");
    expect(std::ranges::all_of(transport.scales, isMagnitude), where,
           "scales that are finite and not negative");
    for (size_t row = 0; row < transport.rows(); row++) {
        const uint64_t start = transport.rowStarts[row], end = transport.rowStarts[row + 1];
        if (end < start || end - start > longestRow || end > transport.entries())
            throw Error(fmt::format("{}: row {}: expected at most {} entries, found entries {} to {}", where,
                                    row, longestRow, start, end));
        uint32_t next = 0;
        for (uint64_t entry = start; entry < end; entry++) {
            const uint32_t index = transport.indices[entry];
            if (index < next || index >= coefficients)
                throw Error(fmt::format("{}: row {}: expected rising indices below {}, found {}", where, row,
                                        coefficients, index));
            next = index + 1;
        }
    }
    expect(std::ranges::all_of(transport.values, isWithinMaxima), where,
           "values within ±1023 in red and green and ±511 in blue");
}

void checkKinds(const BasisTransport& transport, const std::string& where) {
    expect(transport.kinds.size() <= 3 * size_t(transport.terms), where, "at most three kinds a term");
    uint32_t term = 0, ofTerm = 0;
    for (const BasisKind& kind : transport.kinds) {
        expect(kind.term >= term && kind.term < transport.terms, where, "kinds by rising term");
        ofTerm = kind.term == term ? ofTerm + 1 : 1;
        term = kind.term;
        expect(ofTerm <= 3, where, "at most three kinds a term");
        for (int channel = 0; channel < 3; channel++)
            expect(std::isfinite(kind.color[channel]), where, "finite colours of kinds");
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
    uint32_t next = 0;
    for (const uint32_t index : cluster.indices) {
        if (index < next || index >= coefficients)
            throw Error(
                fmt::format("{}: expected rising indices below {}, found {}", where, coefficients, index));
        next = index + 1;
    }
}

void checkTransport(const BasisTransport& transport, uint32_t coefficients, const std::string& where) {
    checkKinds(transport, where);
    expectCount(transport.clusters.size(), transport.clusterCount(), where, "clusters");
    for (size_t number = 0; number < transport.clusters.size(); number++)
        checkCluster(transport.clusters[number], transport.verticesOf(number), transport.kinds.size(),
                     coefficients, fmt::format("{}: cluster {}", where, number));
}

} // namespace relume
