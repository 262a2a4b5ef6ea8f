// Studies and advice as JSON: the output of `relume errors --json` and `relume advise --json`.
#pragma once

#include "precompute/error/advice.h"
#include "precompute/error/error_study.h"

#include <nlohmann/json_fwd.hpp>

namespace relume {

// Describes all numbers of a study: errors of all points, and of those of each visible part, as RMS and as
// shares of the squared total. Includes the low-order study if there is one.
nlohmann::ordered_json describe(const ErrorStudy& study, const ViewPoints& points, const Asset& asset);

// Returns the options of `relume bake` for an advised bake, whose K is set.
std::string commandLineOf(const BakeOptions& options);

// Describes advice; `asked` is the wanted error.
nlohmann::ordered_json describe(const Advice& advice, double asked);

} // namespace relume
