#include "engine/base/error.h"
#include "engine/light/sun_position.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

TEST_CASE("sun position: NREL's example") {
    // Reda, Andreas: Solar Position Algorithm, NREL/TP-560-34302, table A5.1: zenith 50.11162°, azimuth
    // 194.34024°, at 820 mbar, whose refraction is 0.003° less.
    const SunPosition sun = sunPosition(parseMoment("2003-10-17T12:30:30-07:00"), 39.742476, -105.1786);
    CHECK(sun.elevation == doctest::Approx(90 - 50.11162).epsilon(0.01 / 40));
    CHECK(sun.azimuth == doctest::Approx(194.34024).epsilon(0.01 / 194));
}

TEST_CASE("sun position: Meeus's examples") {
    // Astronomical Algorithms, examples 25.a and 28.a, 1992-10-13 0h TD (59 s before UTC): declination
    // -7.785°, equation of time 13 min 42.6 s: noon is where 720 min are 4 longitude + 13.71.
    const Moment moment = parseMoment("1992-10-13T00:00Z");
    const double longitude = (720 - 13.71) / 4;
    const SunPosition noon = sunPosition(moment, 40, longitude);
    CHECK(noon.azimuth == doctest::Approx(180).epsilon(0.02 / 180));
    CHECK(noon.elevation == doctest::Approx(90 - 40 - 7.785 + 0.018).epsilon(0.01 / 42));
    // At the pole the elevation is the declination, and refraction 20.8" / tan 7.785°.
    CHECK(sunPosition(moment, 90, 0).elevation == doctest::Approx(-7.785 + 0.042).epsilon(0.01 / 8));
}

TEST_CASE("sun position: the quarters of a day at an equinox") {
    // 2024-03-20 03:06 UTC, by the Astronomical Almanac.
    const auto at = [](const char* time, double latitude) {
        return sunPosition(parseMoment(std::string("2024-03-20T") + time), latitude, 0);
    };
    CHECK(at("06:07:30Z", 0).azimuth == doctest::Approx(90).epsilon(0.01));
    CHECK(at("12:07:30Z", 0).elevation == doctest::Approx(90).epsilon(0.005));
    CHECK(at("18:07:30Z", 0).azimuth == doctest::Approx(270).epsilon(0.01));
    CHECK(std::abs(at("12:07:30Z", -50).azimuth - 180) > 179); // from the south, the sun is north
    CHECK(at("03:06Z", 90).elevation == doctest::Approx(0.48).epsilon(0.05)); // refraction at the horizon
}

TEST_CASE("sun position: moments are read with their offsets, in leap years too") {
    const auto elevation = [](const char* text) { return sunPosition(parseMoment(text), 48, 11).elevation; };
    CHECK(elevation("2026-06-21T14:30:00+02:00") == elevation("2026-06-21T12:30Z"));
    CHECK(elevation("2026-07-01T01:00+05:30") == doctest::Approx(elevation("2026-06-30T19:30Z")));
    CHECK(elevation("2026-06-21T23:00:00-03:30") == doctest::Approx(elevation("2026-06-22T02:30:00Z")));
    CHECK(elevation("2024-02-29T23:30-01:00") == doctest::Approx(elevation("2024-03-01T00:30Z")));
    CHECK(elevation("1999-12-31T23:30-01:00") == doctest::Approx(elevation("2000-01-01T00:30Z")));
    for (const char* text : {"", "2026-06-21", "2026-06-21T12:30", "2026-06-21T12:30+2", "2026-13-21T12:30Z",
                             "2025-02-29T12:30Z", "2026-06-21T24:30Z", "2026-06-21T12:30Zulu",
                             "1900-06-21T12:30Z", " 026-06-21T12:30Z", "2026-06-21T12:30:61Z"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(parseMoment(text), UsageError);
    }
}
