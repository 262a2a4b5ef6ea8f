#include "engine/transport/cluster_chunk.h"

#include "engine/transport/byte_stream.h"
#include "engine/transport/transport_chunk.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace relume {

namespace {

// Vertices of a cluster of a set.
uint32_t clusterSize(const ClusteredTransport& transport, uint32_t cluster) {
    return std::min(kClusterVertices, transport.vertices - cluster * kClusterVertices);
}

} // namespace

std::vector<std::byte> encodeCluster(const ClusteredTransport& transport, uint32_t cluster, uint32_t offset) {
    const size_t firstGroup = size_t(cluster) * transport.terms, endGroup = firstGroup + transport.terms;
    const uint64_t start = transport.columnStarts[firstGroup], end = transport.columnStarts[endGroup];
    const size_t firstRow = firstGroup * kClusterVertices,
                 rows = size_t(clusterSize(transport, cluster)) * transport.terms;
    std::vector<uint16_t> lengths, gaps(end - start);
    for (size_t group = firstGroup; group < endGroup; group++) {
        lengths.push_back(uint16_t(transport.columnStarts[group + 1] - transport.columnStarts[group]));
        uint32_t next = 0; // the smallest index that may come
        for (uint64_t column = transport.columnStarts[group]; column < transport.columnStarts[group + 1];
             column++) {
            gaps[column - start] = uint16_t(transport.indices[column] - next);
            next = transport.indices[column] + 1u;
        }
    }
    std::vector<uint32_t> scales(rows), values((end - start) * kClusterVertices);
    for (size_t i = 0; i < rows; i++) scales[i] = std::bit_cast<uint32_t>(transport.scales[firstRow + i]);
    std::transform(transport.values.begin() + ptrdiff_t(start * kClusterVertices),
                   transport.values.begin() + ptrdiff_t(end * kClusterVertices), values.begin(), decorrelate);
    ByteWriter out;
    out.put(offset + cluster);
    out.put(clusterSize(transport, cluster));
    out.put(uint32_t(end - start));
    out.putPlanes<uint16_t>(lengths);
    out.putPlanes<uint32_t>(scales);
    out.putPlanes<uint16_t>(gaps);
    out.putPlanes<uint32_t>(values);
    return out.take();
}

void decodeCluster(std::span<const std::byte> raw, uint32_t coefficients, size_t columnLimit,
                   const std::string& where, ClusteredTransport& transport, uint32_t offset) {
    ByteReader in(raw, where);
    const auto cluster = in.get<uint32_t>(), count = in.get<uint32_t>(), columns = in.get<uint32_t>();
    const size_t groupsRead = transport.columnStarts.size() - 1;
    if (groupsRead >= transport.groups() || cluster < offset ||
        size_t(cluster - offset) * transport.terms != groupsRead ||
        count != clusterSize(transport, cluster - offset))
        throw Error(fmt::format("{}: cluster {} of {} vertices does not follow those before it", where,
                                cluster, count));
    const size_t rows = size_t(count) * transport.terms;
    if (columns > columnLimit - transport.columns() || columns > kMostClusterColumns ||
        in.left() != transport.terms * kClusterGroupBytes + rows * kClusterRowBytes +
                         size_t(columns) * kClusterColumnBytes)
        throw Error(
            fmt::format("{}: {} bytes do not hold {} rows and {} columns", where, raw.size(), rows, columns));

    const auto lengths = in.getPlanes<uint16_t>(transport.terms);
    const auto scales = in.getPlanes<uint32_t>(rows);
    const auto gaps = in.getPlanes<uint16_t>(columns);
    const auto values = in.getPlanes<uint32_t>(size_t(columns) * kClusterVertices);
    size_t read = 0;
    for (const uint16_t length : lengths) {
        if (length > columns - read)
            throw Error(fmt::format("{}: groups are longer than the {} columns", where, columns));
        decodeIndices(std::span(gaps).subspan(read, length), coefficients, where, transport.indices);
        read += length;
        transport.columnStarts.push_back(transport.indices.size());
    }
    if (read != columns) throw Error(fmt::format("{}: groups hold {} of {} columns", where, read, columns));
    for (const uint32_t scale : scales) transport.scales.push_back(std::bit_cast<float>(scale));
    transport.values.resize(transport.indices.size() * kClusterVertices);
    std::ranges::transform(values, transport.values.end() - ptrdiff_t(values.size()), correlate);
}

} // namespace relume
