#include "precompute/layout/rows/rows_encoder.h"

#include "engine/transport/rows/rows_chunk.h"
#include "precompute/transport/row_packing.h"

namespace relume {

void makeRows(std::span<MaterialSet* const> sets, const Asset& asset, bool becomeBases,
              ConversionPasses& passes) {
    constexpr uint32_t kTogether = 64;
    const std::vector<SetPlace> places = placesOf(sets, kTogether);
    std::vector<std::vector<PackedRow>> packed(places.size());
    passes.run(places, [&](size_t i) {
        const Transport& transport = sets[places[i].set]->transport;
        const int kept = becomeBases ? rowEntries(asset, *sets[places[i].set]) : asset.coefficients;
        const size_t terms = termsOf(transport), first = places[i].first * terms;
        for (size_t row = first; row < first + places[i].count * terms; row++) {
            const std::vector<vec3> coefficients =
                dequantizedRow(transport, row, size_t(6 * asset.faceSize * asset.faceSize));
            packed[i].push_back(packLargest(coefficients, kept));
        }
    });
    std::vector<SparseTransport> made(sets.size());
    for (size_t set = 0; set < sets.size(); set++) {
        made[set].vertices = verticesOf(sets[set]->transport);
        made[set].terms = termsOf(sets[set]->transport);
        made[set].rowStarts.push_back(0);
    }
    for (size_t i = 0; i < places.size(); i++) {
        SparseTransport& rows = made[places[i].set];
        for (const PackedRow& row : packed[i]) {
            rows.scales.push_back(row.scale);
            rows.indices.insert(rows.indices.end(), row.indices.begin(), row.indices.end());
            rows.values.insert(rows.values.end(), row.values.begin(), row.values.end());
            rows.rowStarts.push_back(rows.values.size());
        }
        packed[i] = {};
    }
    for (size_t set = 0; set < sets.size(); set++) sets[set]->transport = std::move(made[set]);
}

EncodedBlock encodeBlock(const SparseTransport&, const SparseTransport& rows, const BlockCoding& coding) {
    return {encodeRun(rows, {0, rows.vertices}, coding.first), 0};
}

} // namespace relume
