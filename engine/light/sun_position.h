// Where the sun stands.
#pragma once

#include <string>

namespace relume {

// A moment of the Gregorian calendar, in UTC.
struct Moment {
    int year, month, day; // 1901 to 2099; from 1
    double hours;         // since midnight; what is before it or after 24 counts on
};

// Reads ISO 8601: "2026-06-21T14:30:00+02:00"; seconds may be left out, and "Z" is +00:00. The offset is part
// of the moment, so that it is required. Throws UsageError.
Moment parseMoment(const std::string& text);

struct SunPosition {
    double azimuth;   // degrees clockwise from north, [0, 360)
    double elevation; // degrees above the horizon, of the middle of the sun, raised by refraction
};

// By the formulas of NOAA's solar calculator (from Meeus: Astronomical Algorithms, 1991), good to about a
// hundredth of a degree. Latitude in degrees north, longitude in degrees east.
SunPosition sunPosition(const Moment& moment, double latitude, double longitude);

} // namespace relume
