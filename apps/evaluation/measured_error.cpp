#include "apps/evaluation/measured_error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

// Percent, in as many digits as tell the ends of the interval apart, but no more than three behind the point.
std::string percent(double value, double width) {
    int digits = 1;
    for (double step = 0.1; digits < 3 && step > 100 * width; step /= 10) digits++;
    return fmt::format("{:.{}f}", 100 * value, digits);
}

} // namespace

MeasuredError measuredError(const ReferenceError& error) {
    if (!(error.level > 0)) return {};
    const auto root = [&](double square) { return std::sqrt(std::max(square, 0.0)) / error.level; };
    return {root(error.square), root(error.square - 2 * error.squareNoise),
            root(error.square + 2 * error.squareNoise)};
}

std::string textOf(const MeasuredError& error) {
    const double width = error.high - error.low;
    if (error.low <= 0) return "at most " + percent(error.high, error.high) + " %";
    return fmt::format("{} % ({} to {})", percent(error.value, width), percent(error.low, width),
                       percent(error.high, width));
}

bool areDistinguishable(const MeasuredError& a, const MeasuredError& b) {
    const auto square = [](double value) { return value * value; };
    const auto reach = [&](const MeasuredError& error) { return square(error.high) - square(error.value); };
    return std::abs(square(a.value) - square(b.value)) > std::hypot(reach(a), reach(b));
}

void to_json(nlohmann::ordered_json& json, const MeasuredError& error) {
    json = {{"relative_rmse", error.value}, {"low", error.low}, {"high", error.high}};
}

void from_json(const nlohmann::ordered_json& json, MeasuredError& error) {
    error = {json.at("relative_rmse"), json.at("low"), json.at("high")};
}

} // namespace relume
