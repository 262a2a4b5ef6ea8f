#include "engine/light/sun_position.h"

#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/core.h>
#include <string_view>

namespace relume {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

double sine(double degrees) { return std::sin(degrees * kDegree); }
double cosine(double degrees) { return std::cos(degrees * kDegree); }
double tangent(double degrees) { return std::tan(degrees * kDegree); }
double arcCosine(double value) { return std::acos(std::clamp(value, -1.0, 1.0)) / kDegree; }
double wrapped(double degrees) { return degrees - 360 * std::floor(degrees / 360); }

int daysOf(int year, int month) {
    constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return kDays[month - 1] + (month == 2 && year % 4 == 0); // 2000 was a leap year, too
}

// Returns the days since 2000-01-01 12:00 UTC, valid for 1901 to 2099.
double daysSince2000(const Moment& moment) {
    int days = 365 * (moment.year - 2000) + (moment.year - 2000 + 3 + 400) / 4 - 100;
    for (int month = 1; month < moment.month; month++) days += daysOf(moment.year, month);
    return days + moment.day - 1 + (moment.hours - 12) / 24;
}

// Returns by how much refraction raises an object at a true elevation, in degrees.
double refraction(double elevation) {
    const double t = tangent(elevation);
    double seconds = 0;
    if (elevation > 85)
        seconds = 0;
    else if (elevation > 5)
        seconds = 58.1 / t - 0.07 / (t * t * t) + 0.000086 / std::pow(t, 5);
    else if (elevation > -0.575)
        seconds =
            1735 + elevation * (-518.2 + elevation * (103.4 + elevation * (-12.79 + elevation * 0.711)));
    else
        seconds = -20.772 / t;
    return seconds / 3600;
}

} // namespace

Moment parseMoment(const std::string& text) {
    Moment moment{};
    const auto refuse = [&] {
        throw UsageError(fmt::format(
            "expected a moment of 1901 to 2099 like \"2026-06-21T14:30:00+02:00\", with its offset from "
            "UTC or Z, found \"{}\"",
            text.substr(0, 40)));
    };
    // Returns whether `part` has a digit for each 0 of `shape` and equals it elsewhere.
    const auto isLike = [](std::string_view part, std::string_view shape) {
        return std::ranges::equal(part, shape, [](char letter, char expected) {
            return expected == '0' ? letter >= '0' && letter <= '9' : letter == expected;
        });
    };
    const auto number = [](std::string_view digits) {
        int value = 0;
        for (char digit : digits) value = 10 * value + (digit - '0');
        return value;
    };
    const std::string_view all = text;
    constexpr size_t kDate = 16; // date and time without seconds
    if (!isLike(all.substr(0, kDate), "0000-00-00T00:00")) refuse();
    moment = {number(all.substr(0, 4)), number(all.substr(5, 2)), number(all.substr(8, 2)), 0};
    const int hour = number(all.substr(11, 2)), minute = number(all.substr(14, 2));
    const bool hasSeconds = isLike(all.substr(kDate, 3), ":00");
    const int second = hasSeconds ? number(all.substr(kDate + 1, 2)) : 0;
    const std::string_view zone = all.substr(hasSeconds ? kDate + 3 : kDate);
    int offset = 0;
    if (isLike(zone, "+00:00") || isLike(zone, "-00:00"))
        offset = (zone[0] == '-' ? -1 : 1) * (60 * number(zone.substr(1, 2)) + number(zone.substr(4, 2)));
    else if (zone != "Z")
        refuse();
    if (moment.year < 1901 || moment.year > 2099 || moment.month < 1 || moment.month > 12 || moment.day < 1 ||
        moment.day > daysOf(moment.year, moment.month) || hour > 23 || minute > 59 || second > 59 ||
        std::abs(offset) > 24 * 60)
        refuse();
    moment.hours = hour + (minute - offset) / 60.0 + second / 3600.0;
    return moment;
}

SunPosition sunPosition(const Moment& moment, double latitude, double longitude) {
    const double days = daysSince2000(moment), century = days / 36525;
    const double meanLongitude = wrapped(280.46646 + century * (36000.76983 + century * 0.0003032));
    const double anomaly = 357.52911 + century * (35999.05029 - 0.0001537 * century);
    const double eccentricity = 0.016708634 - century * (0.000042037 + 0.0000001267 * century);
    const double center = sine(anomaly) * (1.914602 - century * (0.004817 + 0.000014 * century)) +
                          sine(2 * anomaly) * (0.019993 - 0.000101 * century) + sine(3 * anomaly) * 0.000289;
    const double node = 125.04 - 1934.136 * century;
    const double apparent = meanLongitude + center - 0.00569 - 0.00478 * sine(node);
    const double obliquity =
        23 + (26 + (21.448 - century * (46.815 + century * (0.00059 - century * 0.001813))) / 60) / 60 +
        0.00256 * cosine(node);
    const double declination = std::asin(sine(obliquity) * sine(apparent)) / kDegree;
    const double y = std::pow(tangent(obliquity / 2), 2);
    const double equation = 4 / kDegree *
                            (y * sine(2 * meanLongitude) - 2 * eccentricity * sine(anomaly) +
                             4 * eccentricity * y * sine(anomaly) * cosine(2 * meanLongitude) -
                             0.5 * y * y * sine(4 * meanLongitude) -
                             1.25 * eccentricity * eccentricity * sine(2 * anomaly)); // minutes
    const double solarMinutes = 60 * moment.hours + equation + 4 * longitude;
    const double hourAngle = wrapped(solarMinutes / 4) - 180;

    const double zenith = arcCosine(sine(latitude) * sine(declination) +
                                    cosine(latitude) * cosine(declination) * cosine(hourAngle));
    // Azimuth from the south by components, so that no division fails at the poles or below the sun.
    const double west = sine(hourAngle);
    const double south = cosine(hourAngle) * sine(latitude) - tangent(declination) * cosine(latitude);
    const double elevation = 90 - zenith;
    return {wrapped(180 + std::atan2(west, south) / kDegree), elevation + refraction(elevation)};
}

} // namespace relume
