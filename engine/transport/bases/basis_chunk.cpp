#include "engine/transport/bases/basis_chunk.h"

#include "engine/chunk/block_chunk.h"
#include "engine/chunk/byte_stream.h"
#include "engine/scene/factored_brdf.h"

#include <bit>
#include <fmt/core.h>

namespace relume {

namespace {

static_assert(largestBasisChunk(kMostTerms) <= kLargestChunk);

// Transposes a matrix of bytes with `rows` rows and `columns` columns.
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
    forEachGap(cluster.indices, [&](uint16_t gap) { gaps.push_back(gap); });
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
    // Values of a component are stored together, since they are of similar size.
    out.put(transposed(std::as_bytes(std::span(cluster.basis)), cluster.columns(), cluster.components));
    std::span<const std::byte> weights = std::as_bytes(std::span(cluster.weights));
    for (const size_t count : cluster.counts) {
        out.put(transposed(weights.first(vertices * count), vertices, count));
        weights = weights.subspan(vertices * count);
    }
    return out.take();
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

void addTransport(ChunkWriter& file, uint32_t owner, const BasisTransport& transport, uint32_t) {
    for (size_t cluster = 0; cluster < transport.clusters.size(); cluster++)
        file.add(BasisTransport::kTag, owner, uint32_t(cluster),
                 encodeBasisCluster(transport.clusters[cluster], uint32_t(cluster),
                                    transport.verticesOf(cluster)));
}

void readTransport(const ChunkFile& file, uint32_t owner, uint64_t columns, uint32_t coefficients,
                   BasisTransport& transport) {
    for (const ChunkEntry& run : file.find(BasisTransport::kTag, owner)) {
        const size_t next = transport.clusters.size();
        if (next >= transport.clusterCount())
            throw Error(fmt::format("{}: expected {} clusters, found more", whereOf(file, run, "set"),
                                    transport.clusterCount()));
        transport.clusters.push_back(decodeBasisCluster(file.load(run), uint32_t(next),
                                                        transport.verticesOf(next), transport.kinds.size(),
                                                        coefficients, whereOf(file, run, "set")));
    }
    if (transport.clusters.size() != transport.clusterCount() || transport.entries() != columns)
        throw Error(fmt::format("{}: expected {} clusters with {} columns, found {} with {}",
                                whereOf(file, BasisTransport::kTag, owner, "set"), transport.clusterCount(),
                                columns, transport.clusters.size(), transport.entries()));
}

ChunkSizes chunkSizes(const BasisTransport& layout, uint32_t, int) {
    return {kBasisHeaderBytes, largestBasisChunk(layout.terms), 1};
}

uint64_t memoryBytes(const BasisTransport&, uint32_t, uint64_t rawSize) {
    return rawSize - kBasisHeaderBytes;
}

uint64_t entriesOf(const BasisTransport&, uint32_t, uint64_t, const LoadChunk& load) {
    const std::vector<std::byte> raw = load(); // only its content tells the number of columns
    ByteReader in(raw, "the bake");
    in.take(2 * sizeof(uint32_t));
    return in.get<uint32_t>();
}

void checkChunk(const BasisTransport& layout, const BlockPlace& place, std::span<const std::byte> raw,
                const RowLimits& limits, const std::string& where) {
    decodeBasisCluster(raw, place.run, place.vertices, layout.kinds.size(), limits.coefficients, where);
}

} // namespace relume
