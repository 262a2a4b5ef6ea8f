// An image's error with the interval it is known within: what every figure and table of the report states.
#pragma once

#include "precompute/reference/progressive_reference.h"

#include <nlohmann/json.hpp>
#include <string>

namespace relume {

// Root mean square over covered pixels and channels, relative to that of the truth. Low and high: two
// standard errors of the squared error either way, of the reference's noise alone.
struct MeasuredError {
    double value = 0, low = 0, high = 0;
};

MeasuredError measuredError(const ReferenceError& error);

// "4.41 % (4.38 to 4.44)", or "at most 0.31 %" where the interval reaches 0.
std::string textOf(const MeasuredError& error);

// Whether the squared errors differ by more than two standard errors of their difference, taken as if their
// noise were independent: of images held against one reference this asks for more than it takes.
bool areDistinguishable(const MeasuredError& a, const MeasuredError& b);

void to_json(nlohmann::ordered_json& json, const MeasuredError& error);
void from_json(const nlohmann::ordered_json& json, MeasuredError& error);

} // namespace relume
