// A set's transport, in whichever layout it is kept.
#pragma once

#include "engine/transport/basis_transport.h"
#include "engine/transport/sparse_transport.h"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace relume {

using Transport = std::variant<SparseTransport, BasisTransport>;

// In the order of Transport's alternatives.
enum class TransportLayout { Rows, Bases };

inline TransportLayout layoutOf(const Transport& transport) { return TransportLayout(transport.index()); }
Transport emptyTransport(TransportLayout layout, uint32_t vertices, uint32_t terms);
const char* layoutName(TransportLayout layout); // "rows", "bases"
std::optional<TransportLayout> layoutFromName(std::string_view name);

// Returns the layout that a file names. `where` stands for the file in errors. Throws Error for names of no
// layout, and for "clusters", which version 0.1 had.
TransportLayout readLayoutName(std::string_view name, const std::string& where);

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
