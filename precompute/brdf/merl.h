// Measured BRDFs in the format of the MERL database: Matusik, Pfister, Brand and McMillan, "A Data-Driven
// Reflectance Model", SIGGRAPH 2003.
#pragma once

#include "precompute/brdf/isotropic_table.h"

#include <cstddef>
#include <span>
#include <string>

namespace relume {

// Whether the bytes begin as such a file does.
bool looksLikeMerl(std::span<const std::byte> bytes);

// The file: int32 90, 90, 180 (cells along θh, θd and φd); then float64 values, φd fastest, red, green and
// blue one after another, to be scaled by 1, 1.15 and 1.66 over 1500. Returns the table with what is missing
// (a negative value, a cell below the horizon) filled from its neighbors and grazing cells limited
// (table_repair.h); the log says how many. Throws Error naming `name` for anything else than such a file, and
// for values that are not finite.
IsotropicTable parseMerl(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
