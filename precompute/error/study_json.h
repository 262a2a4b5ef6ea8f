// A study as data: what `relume errors --json` prints, and an evaluation keeps.
#pragma once

#include "precompute/error/error_study.h"

#include <nlohmann/json_fwd.hpp>

namespace relume {

// All of the study's numbers: relative root mean squares, and shares of the squared total. The harmonics'
// where the study has any.
nlohmann::ordered_json describe(const ErrorStudy& study);

} // namespace relume
