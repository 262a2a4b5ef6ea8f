#include "precompute/bake/baked_rows.h"

#include "engine/base/check.h"
#include "precompute/transport/row_sum.h"

#include <algorithm>
#include <cmath>

namespace relume {

BakedRows::BakedRows(uint32_t terms) : transport(emptyRows(terms)) {}

std::vector<BakedRows> emptyBakedRows(const AssetPart& part) {
    std::vector<BakedRows> rows;
    for (const MaterialSet& set : part.sets) rows.emplace_back(uint32_t(set.brdf.terms));
    return rows;
}

BakedRows BakedRows::vertices(uint32_t first, uint32_t end) const {
    RELUME_CHECK_LE(end, transport.vertices);
    BakedRows part(transport.terms);
    const size_t firstRow = size_t(first) * transport.terms, endRow = size_t(end) * transport.terms;
    const uint64_t firstEntry = transport.rowStarts[firstRow], endEntry = transport.rowStarts[endRow];
    const auto slice = [](const auto& values, uint64_t from, uint64_t to) {
        return std::vector(values.begin() + ptrdiff_t(from), values.begin() + ptrdiff_t(to));
    };
    part.transport.vertices = end - first;
    for (size_t row = firstRow; row < endRow; row++)
        part.transport.rowStarts.push_back(transport.rowStarts[row + 1] - firstEntry);
    part.transport.scales = slice(transport.scales, firstRow, endRow);
    part.transport.indices = slice(transport.indices, firstEntry, endEntry);
    part.transport.values = slice(transport.values, firstEntry, endEntry);
    part.losses = slice(losses, firstRow, endRow);
    return part;
}

void BakedRows::append(const BakedRows& more) {
    appendRows(transport, more.transport);
    losses.insert(losses.end(), more.losses.begin(), more.losses.end());
}

TransportLosses BakedBlock::losses() const {
    TransportLosses sum;
    for (const BakedRows& set : sets)
        for (const TransportLosses& row : set.losses) sum.add(row);
    return sum;
}

static float relative(double lost, double total) { return total > 0 ? float(std::sqrt(lost / total)) : 0; }

void setErrors(const TransportLosses& losses, Asset& asset) {
    asset.truncationError = relative(losses.dropped, losses.total);
    asset.quantizationError = relative(losses.quantized, losses.total - losses.dropped);
    if (!asset.layout) return;
    uint64_t vertices = 0; // counted once per set, whose errors have normalizations of their own
    for (const AssetPart& part : asset.parts) vertices += part.mesh.vertexCount() * part.sets.size();
    asset.layout->error = std::sqrt(losses.layout / double(std::max<uint64_t>(1, vertices)));
}

} // namespace relume
