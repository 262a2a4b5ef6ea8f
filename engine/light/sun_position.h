// The position of the sun in the sky.
#pragma once

#include <string>

namespace relume {

// A moment of the Gregorian calendar, in UTC.
struct Moment {
    int year, month, day; // 1901 to 2099; from 1
    double hours;         // since midnight; may be negative or above 24
};

// Reads ISO 8601, as in "2026-06-21T14:30:00+02:00". Seconds may be omitted, and "Z" stands for +00:00. The
// offset from UTC is required. Throws UsageError.
Moment parseMoment(const std::string& text);

struct SunPosition {
    double azimuth;   // degrees clockwise from north, [0, 360)
    double elevation; // degrees above the horizon of the sun's center, raised by refraction
};

// Returns the sun's position by the formulas of NOAA's solar calculator (from Meeus: Astronomical Algorithms,
// 1991), accurate to about a hundredth of a degree. Latitude is in degrees north, longitude in degrees east.
SunPosition sunPosition(const Moment& moment, double latitude, double longitude);

} // namespace relume
