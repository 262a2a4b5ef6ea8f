#include "engine/transport/transport.h"

#include "engine/base/error.h"

#include <fmt/format.h>
#include <span>

namespace relume {

namespace {

template <typename Element>
uint64_t bytes(const std::vector<Element>& elements) {
    return std::span(elements).size_bytes();
}

uint64_t bytesOf(const SparseTransport& transport) {
    return bytes(transport.scales) + bytes(transport.indices) + bytes(transport.values);
}

uint64_t bytesOf(const BasisTransport& transport) {
    uint64_t sum = 0;
    for (const BasisCluster& cluster : transport.clusters)
        sum += bytes(cluster.indices) + bytes(cluster.basis) + bytes(cluster.counts) + bytes(cluster.scales) +
               bytes(cluster.weights);
    return sum;
}

void addCoefficients(const SparseTransport& transport, size_t row, std::span<vec3> coefficients) {
    const vec3 unit = transport.scales[row] * kCoefficientUnit;
    for (uint64_t entry = transport.rowStarts[row]; entry < transport.rowStarts[row + 1]; entry++)
        coefficients[transport.indices[entry]] = vec3(unpackCoefficient(transport.values[entry])) * unit;
}

void addCoefficients(const BasisTransport& transport, size_t row, std::span<vec3> coefficients) {
    const size_t vertex = row / transport.terms, term = row % transport.terms;
    const size_t number = vertex / kBasisVertices, own = vertex % kBasisVertices;
    const BasisCluster& cluster = transport.clusters[number];
    size_t scale = 0, weight = 0; // where the kind's begin
    for (size_t kind = 0; kind < transport.kinds.size(); kind++) {
        const size_t count = cluster.counts[kind];
        if (transport.kinds[kind].term == term)
            for (size_t column = 0; column < cluster.columns(); column++) {
                float sum = 0;
                for (size_t i = 0; i < count; i++)
                    sum += cluster.scales[scale + i] * float(cluster.weights[weight + own * count + i]) *
                           float(cluster.basis[column * cluster.components + i]);
                coefficients[cluster.indices[column]] += transport.kinds[kind].color * sum;
            }
        scale += count;
        weight += count * transport.verticesOf(number);
    }
}

} // namespace

Transport emptyTransport(TransportLayout layout, uint32_t vertices, uint32_t terms) {
    if (layout == TransportLayout::Bases)
        return BasisTransport{.vertices = vertices, .terms = terms, .kinds = {}, .clusters = {}};
    return SparseTransport{
        .vertices = vertices, .terms = terms, .rowStarts = {}, .scales = {}, .indices = {}, .values = {}};
}

const char* layoutName(TransportLayout layout) {
    switch (layout) {
    case TransportLayout::Rows:
        return "rows";
    case TransportLayout::Bases:
        return "bases";
    }
    return "";
}

std::optional<TransportLayout> layoutFromName(std::string_view name) {
    for (size_t i = 0; i < std::variant_size_v<Transport>; i++)
        if (name == layoutName(TransportLayout(i))) return TransportLayout(i);
    return std::nullopt;
}

TransportLayout readLayoutName(std::string_view name, const std::string& where) {
    if (const auto layout = layoutFromName(name)) return *layout;
    if (name == "clusters")
        throw Error(fmt::format(
            "{}: transport is in clusters, a layout that is no longer read; bake again, or convert "
            "the file with the program that made it: relume convert FILE --layout bases -o NEW",
            where));
    throw Error(fmt::format(
        "{}: transport is in the layout \"{}\", and this program knows rows and bases; the file is "
        "damaged or of a later program",
        where, name));
}

uint32_t verticesOf(const Transport& transport) {
    return std::visit([](const auto& kept) { return kept.vertices; }, transport);
}

uint32_t termsOf(const Transport& transport) {
    return std::visit([](const auto& kept) { return kept.terms; }, transport);
}

std::vector<vec3> coefficientsOf(const Transport& transport, size_t row, size_t count) {
    std::vector<vec3> coefficients(count, vec3(0));
    std::visit([&](const auto& kept) { addCoefficients(kept, row, coefficients); }, transport);
    return coefficients;
}

uint64_t entriesOf(const Transport& transport) {
    if (const auto* bases = std::get_if<BasisTransport>(&transport)) {
        uint64_t columns = 0;
        for (const BasisCluster& cluster : bases->clusters) columns += cluster.columns();
        return columns;
    }
    return rowsOf(transport).entries();
}

uint64_t bytesOf(const Transport& transport) {
    return std::visit([](const auto& kept) { return bytesOf(kept); }, transport);
}

} // namespace relume
