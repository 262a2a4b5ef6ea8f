#include "engine/transport/basis_chunk.h"

#include "engine/transport/byte_stream.h"
#include "engine/transport/transport_check.h"
#include "engine/transport/transport_chunk.h"

#include <bit>
#include <fmt/format.h>

namespace relume {

namespace {

// Rows of `columns` values each, column after column.
std::vector<std::byte> transposed(std::span<const std::byte> values, size_t rows, size_t columns) {
    std::vector<std::byte> result(values.size());
    for (size_t row = 0; row < rows; row++)
        for (size_t column = 0; column < columns; column++)
            result[column * rows + row] = values[row * columns + column];
    return result;
}

void appendSigned(std::span<const std::byte> bytes, std::vector<int8_t>& values) {
    for (const std::byte byte : bytes) values.push_back(int8_t(byte));
}

} // namespace

std::vector<std::byte> encodeBasisCluster(const BasisCluster& cluster, uint32_t number, uint32_t vertices) {
    std::vector<uint16_t> gaps;
    uint32_t next = 0; // the smallest index that may come
    for (const uint32_t index : cluster.indices) {
        gaps.push_back(uint16_t(index - next));
        next = index + 1;
    }
    std::vector<uint32_t> scales;
    for (const float scale : cluster.scales) scales.push_back(std::bit_cast<uint32_t>(scale));
    ByteWriter out;
    out.put(number);
    out.put(vertices);
    out.put(uint32_t(cluster.columns()));
    out.put(cluster.components);
    out.putPlanes<uint16_t>(cluster.counts);
    out.putPlanes<uint32_t>(scales);
    out.putPlanes<uint16_t>(gaps);
    // All values of a component together: they are of a size.
    out.put(transposed(std::as_bytes(std::span(cluster.basis)), cluster.columns(), cluster.components));
    std::span<const std::byte> weights = std::as_bytes(std::span(cluster.weights));
    for (const size_t count : cluster.counts) {
        out.put(transposed(weights.first(vertices * count), vertices, count));
        weights = weights.subspan(vertices * count);
    }
    return out.take();
}

uint32_t basisColumns(std::span<const std::byte> raw, const std::string& where) {
    ByteReader in(raw, where);
    in.take(2 * sizeof(uint32_t));
    return in.get<uint32_t>();
}

BasisCluster decodeBasisCluster(std::span<const std::byte> raw, uint32_t number, uint32_t vertices,
                                size_t kinds, uint32_t coefficients, const std::string& where) {
    ByteReader in(raw, where);
    const auto foundNumber = in.get<uint32_t>(), foundVertices = in.get<uint32_t>();
    const auto columns = in.get<uint32_t>();
    BasisCluster cluster;
    cluster.components = in.get<uint32_t>();
    if (foundNumber != number || foundVertices != vertices)
        throw Error(fmt::format("{}: expected cluster {} of {} vertices, found {} of {}", where, number,
                                vertices, foundNumber, foundVertices));
    if (columns > kMostBasisColumns || cluster.components > kMostBasisComponents)
        throw Error(fmt::format("{}: expected at most {} columns and {} components, found {} and {}", where,
                                kMostBasisColumns, kMostBasisComponents, columns, cluster.components));
    cluster.counts = in.getPlanes<uint16_t>(kinds);
    size_t scales = 0;
    for (const size_t count : cluster.counts) scales += count;
    const size_t basis = size_t(columns) * cluster.components;
    if (in.left() != scales * sizeof(float) + columns * sizeof(uint16_t) + basis + scales * vertices)
        throw Error(
            fmt::format("{}: {} bytes do not hold {} columns of {} components and {} weights a vertex", where,
                        raw.size(), columns, cluster.components, scales));
    for (const uint32_t scale : in.getPlanes<uint32_t>(scales))
        cluster.scales.push_back(std::bit_cast<float>(scale));
    decodeIndices(in.getPlanes<uint16_t>(columns), coefficients, where, cluster.indices);
    appendSigned(transposed(in.take(basis), cluster.components, columns), cluster.basis);
    for (const size_t count : cluster.counts)
        appendSigned(transposed(in.take(count * vertices), count, vertices), cluster.weights);
    checkCluster(cluster, vertices, kinds, coefficients, where);
    return cluster;
}

} // namespace relume
