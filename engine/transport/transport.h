// A set's transport, in any layout.
#pragma once

#include "engine/transport/bases/basis_transport.h"
#include "engine/transport/rows/sparse_transport.h"

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace relume {

// A new layout needs an alternative here, a folder here and in precompute/layout, and its number below; the
// compiler asks for the rest. Whatever works on transport is a function with an overload per layout, called
// by std::visit: a layout that lacks one does not compile.
using Transport = std::variant<SparseTransport, BasisTransport>;

// The layouts, in the order of Transport's alternatives.
enum class TransportLayout { Rows, Bases };

// Properties of a layout as such.
struct LayoutFacts {
    const char* name;        // in files and options
    std::array<char, 4> tag; // of its chunks
};
inline constexpr auto kLayoutFacts = []<typename... Kept>(std::type_identity<std::variant<Kept...>>) {
    return std::array{LayoutFacts{Kept::kName, Kept::kTag}...};
}(std::type_identity<Transport>());
static_assert(size_t(TransportLayout::Bases) + 1 == kLayoutFacts.size());
static_assert(
    std::is_same_v<std::variant_alternative_t<size_t(TransportLayout::Rows), Transport>, SparseTransport>);
static_assert(
    std::is_same_v<std::variant_alternative_t<size_t(TransportLayout::Bases), Transport>, BasisTransport>);

inline TransportLayout layoutOf(const Transport& transport) { return TransportLayout(transport.index()); }
constexpr const char* layoutName(TransportLayout layout) { return kLayoutFacts[size_t(layout)].name; }
constexpr std::array<char, 4> layoutTag(TransportLayout layout) { return kLayoutFacts[size_t(layout)].tag; }
bool isLayoutTag(std::array<char, 4> tag);
std::optional<TransportLayout> layoutFromName(std::string_view name);

// Returns whether a layout is made from rows, which are what is baked.
constexpr bool isCompressed(TransportLayout layout) { return layout != TransportLayout::Rows; }

// Returns the layout that a file names; `where` names the file in errors. Throws Error for unknown names, and
// for "clusters", which version 0.1 had.
TransportLayout readLayoutName(std::string_view name, const std::string& where);

// Returns transport of these sizes without rows or clusters.
Transport emptyTransport(TransportLayout layout, uint32_t vertices, uint32_t terms);

// Return the transport of a set that is known to be in rows.
inline SparseTransport& rowsOf(Transport& transport) { return std::get<SparseTransport>(transport); }
inline const SparseTransport& rowsOf(const Transport& transport) {
    return std::get<SparseTransport>(transport);
}

uint32_t verticesOf(const Transport& transport);
uint32_t termsOf(const Transport& transport);

// Returns `count` dequantized coefficients of a row: of term row % terms of vertex row / terms.
std::vector<vec3> dequantizedRow(const Transport& transport, size_t row, size_t count);

// Returns the number of row entries, or for bases the number of columns of all clusters.
uint64_t entriesOf(const Transport& transport);

// Returns the bytes in memory of the arrays that relighting reads.
uint64_t bytesOf(const Transport& transport);

} // namespace relume
