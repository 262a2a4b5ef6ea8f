// Measured BRDFs in the format of the MERL database: Matusik, Pfister, Brand and McMillan, "A Data-Driven
// Reflectance Model", SIGGRAPH 2003.
#pragma once

#include "precompute/brdf/isotropic_table.h"

#include <cstddef>
#include <span>
#include <string>

namespace relume {

// Returns whether the bytes begin like a MERL file.
bool looksLikeMerl(std::span<const std::byte> bytes);

// Parses a file: int32 90, 90, 180 (cells along θh, θd and φd), then float64 values, φd fastest, all of red,
// green and blue in turn, to be scaled by 1, 1.15 and 1.66 over 1500. Fills missing cells (negative or below
// the horizon) from their neighbors and limits grazing ones (table_repair.h); the log says how many. Throws
// Error naming `name` for any other file and for values that are not finite.
IsotropicTable parseMerl(std::span<const std::byte> bytes, const std::string& name);

} // namespace relume
