// A set's transport, in whichever layout it is kept.
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

// A layout is an alternative here, a folder here and in precompute/layout, and its number below, besides what
// the compiler asks for. What is done to transport is a function that each layout has one of, found by
// std::visit: a layout that lacks one does not compile.
using Transport = std::variant<SparseTransport, BasisTransport>;

// In the order of Transport's alternatives.
enum class TransportLayout { Rows, Bases };

// Facts of a layout that hold without any transport.
struct LayoutFacts {
    const char* name;        // as files and options have it
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

// Rows are what is baked; every other layout is made of them.
constexpr bool isCompressed(TransportLayout layout) { return layout != TransportLayout::Rows; }

// Returns the layout that a file names. `where` stands for the file in errors. Throws Error for names of no
// layout, and for "clusters", which version 0.1 had.
TransportLayout readLayoutName(std::string_view name, const std::string& where);

Transport emptyTransport(TransportLayout layout, uint32_t vertices, uint32_t terms);

// Of a set that is known to be in rows.
inline SparseTransport& rowsOf(Transport& transport) { return std::get<SparseTransport>(transport); }
inline const SparseTransport& rowsOf(const Transport& transport) {
    return std::get<SparseTransport>(transport);
}

uint32_t verticesOf(const Transport& transport);
uint32_t termsOf(const Transport& transport);

// The coefficients, `count` of them, that a row stands for: of term row % terms of vertex row / terms.
std::vector<vec3> coefficientsOf(const Transport& transport, size_t row, size_t count);

// Returns the number of entries of rows, or of columns of bases.
uint64_t entriesOf(const Transport& transport);

// What relighting may read of it, in memory: coefficients, indices, weights and scales.
uint64_t bytesOf(const Transport& transport);

} // namespace relume
