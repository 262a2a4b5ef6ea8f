// Studies and advice as data: what `relume errors --json` and `relume advise --json` print.
#pragma once

#include "precompute/error/advice.h"
#include "precompute/error/error_study.h"

#include <nlohmann/json_fwd.hpp>

namespace relume {

// All of the study's numbers: relative root mean squares, and shares of the squared total, of all points and
// of those of each part that is seen. The harmonics' where the study has any.
nlohmann::ordered_json describe(const ErrorStudy& study, const ViewPoints& points, const Asset& asset);

// The options of `relume bake` for an advised bake.
std::string commandLineOf(const BakeOptions& options);

// What `relume advise --json` prints; `asked`: the error.
nlohmann::ordered_json describe(const Advice& advice, double asked);

} // namespace relume
