#include "engine/transport/transport.h"

#include "engine/base/error.h"

#include <algorithm>
#include <fmt/core.h>

namespace relume {

bool isLayoutTag(std::array<char, 4> tag) {
    return std::ranges::find(kLayoutFacts, tag, &LayoutFacts::tag) != kLayoutFacts.end();
}

std::optional<TransportLayout> layoutFromName(std::string_view name) {
    for (size_t i = 0; i < kLayoutFacts.size(); i++)
        if (name == kLayoutFacts[i].name) return TransportLayout(i);
    return std::nullopt;
}

TransportLayout readLayoutName(std::string_view name, const std::string& where) {
    if (const auto layout = layoutFromName(name)) return *layout;
    if (name == "clusters")
        throw Error(
            fmt::format("{}: transport is in clusters, a layout that is no longer read; bake again, or "
                        "convert the file with the program that made it: relume convert FILE --layout "
                        "bases -o NEW",
                        where));
    std::string known;
    for (const LayoutFacts& facts : kLayoutFacts)
        known += fmt::format("{}{}", known.empty() ? "" : " and ", facts.name);
    throw Error(fmt::format("{}: transport is in the layout \"{}\", and this program knows {}; the file is "
                            "damaged or of a later program",
                            where, name, known));
}

Transport emptyTransport(TransportLayout layout, uint32_t vertices, uint32_t terms) {
    Transport transport;
    [&]<size_t... I>(std::index_sequence<I...>) {
        ((I == size_t(layout) ? void(transport.emplace<I>()) : void()), ...);
    }
    (std::make_index_sequence<kLayoutFacts.size()>());
    std::visit([&](auto& made) { made.vertices = vertices, made.terms = terms; }, transport);
    return transport;
}

uint32_t verticesOf(const Transport& transport) {
    return std::visit([](const auto& layout) { return layout.vertices; }, transport);
}

uint32_t termsOf(const Transport& transport) {
    return std::visit([](const auto& layout) { return layout.terms; }, transport);
}

std::vector<vec3> dequantizedRow(const Transport& transport, size_t row, size_t count) {
    std::vector<vec3> coefficients(count, vec3(0));
    std::visit([&](const auto& layout) { layout.dequantizeRow(row, coefficients); }, transport);
    return coefficients;
}

uint64_t entriesOf(const Transport& transport) {
    return std::visit([](const auto& layout) -> uint64_t { return layout.entries(); }, transport);
}

uint64_t bytesOf(const Transport& transport) {
    return std::visit([](const auto& layout) { return layout.bytes(); }, transport);
}

} // namespace relume
