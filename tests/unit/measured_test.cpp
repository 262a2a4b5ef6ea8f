// Tests measured BRDFs: the MERL format against a reader written here, Cornell's against known spectra;
// repairs; hostile files.
#include "engine/base/error.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/cornell.h"
#include "precompute/brdf/merl.h"
#include "precompute/brdf/spectrum.h"
#include "precompute/brdf/table_repair.h"
#include "tests/support/failure.h"
#include "tests/support/log_capture.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

using namespace relume;
using namespace relume::test;
using dvec3 = glm::dvec3;

namespace {

constexpr double kExactPi = 3.14159265358979323846;

dvec3 turn(dvec3 v, dvec3 axis, double angle) {
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * glm::dot(axis, v) * (1 - std::cos(angle));
}

// The places of a pair of directions along θh, θd and φd, in cells, by the rotations of the format's
// definition.
dvec3 merlPlace(dvec3 in, dvec3 out) {
    const dvec3 half = glm::normalize((in + out) * 0.5);
    const double thetaHalf = std::acos(half.z), phiHalf = std::atan2(half.y, half.x);
    const dvec3 difference = turn(turn(in, {0, 0, 1}, -phiHalf), {0, 1, 0}, -thetaHalf);
    double phi = std::atan2(difference.y, difference.x);
    if (phi < 0) phi += kExactPi;
    return {std::sqrt(thetaHalf / (kExactPi / 2) * 90 * 90), std::acos(difference.z) / (kExactPi / 2) * 90,
            phi / kExactPi * 180};
}

size_t merlCell(int half, int difference, int phi) { return size_t(phi + 180 * (difference + 90 * half)); }

// A MERL file of an analytic BRDF at the middle of every cell; -1 below the horizon.
struct MerlFile {
    std::vector<double> values;

    explicit MerlFile(const Brdf& brdf) : values(3 * 90 * 90 * 180) {
        for (int h = 0; h < 90; h++)
            for (int d = 0; d < 90; d++)
                for (int p = 0; p < 180; p++) {
                    const double thetaHalf = std::pow((h + 0.5) / 90, 2) * kExactPi / 2;
                    const double theta = (d + 0.5) / 90 * kExactPi / 2, phi = (p + 0.5) / 180 * kExactPi;
                    const dvec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                   std::cos(theta));
                    const dvec3 in = turn(wi, {0, 1, 0}, thetaHalf);
                    const dvec3 out = turn({-wi.x, -wi.y, wi.z}, {0, 1, 0}, thetaHalf);
                    const bool isAbove = in.z > 0 && out.z > 0;
                    const dvec3 value = isAbove ? dvec3(brdf.evaluate(in, out)) : dvec3(-1);
                    for (size_t c = 0; c < 3; c++) at(c, h, d, p) = isAbove ? value[int(c)] / scale(c) : -1;
                }
    }

    static double scale(size_t channel) { return std::array{1.0, 1.15, 1.66}[channel] / 1500; }
    double& at(size_t channel, int h, int d, int p) { return values[channel * 1458000 + merlCell(h, d, p)]; }

    std::string bytes() const {
        const int32_t sizes[3] = {90, 90, 180};
        std::string text(12 + values.size() * sizeof(double), 0);
        std::memcpy(text.data(), sizes, 12);
        std::memcpy(text.data() + 12, values.data(), values.size() * sizeof(double));
        return text;
    }
};

const MerlFile& plasticFile() {
    static const MerlFile file(*makeBrdf("red-plastic"));
    return file;
}

IsotropicTable parse(const MerlFile& file) {
    const std::string bytes = file.bytes();
    return parseMerl(std::as_bytes(std::span(bytes)), "test.binary");
}

vec3 randomDirection(std::mt19937& random, float least) {
    std::uniform_real_distribution<float> uniform(0, 1);
    const float z = least + (1 - least) * uniform(random), phi = 2 * kPi * uniform(random);
    return {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
}

// The message of the Error that the material causes; fails the test if it causes none.
std::string errorOf(const std::string& material, const std::filesystem::path& folder = {}) {
    try {
        makeBrdf(material, folder);
    } catch (const Error& error) {
        return error.what();
    }
    FAIL("accepted: " << material);
    return {};
}

// A Cornell file of a spectrum that is the same in all directions, with `extra` as further lines.
std::string cornellText(const std::function<double(double)>& spectrum, const std::string& extra = "") {
    std::ostringstream text;
    text << "# a comment\n\n# num wls\n31\n";
    for (int i = 0; i < 31; i++) text << 400 + 10 * i << (i % 19 == 18 ? "\n" : " ");
    text << "\n# samples\n\n";
    for (int t = 0; t < 6; t++)
        for (int s = 0; s < 6; s++)
            for (int p = 0; p < 4; p++) {
                text << 0.1 + 0.25 * t << " 0.0 " << 0.1 + 0.25 * s << " " << p * -0.7;
                for (int i = 0; i < 31; i++) text << " " << spectrum(400 + 10 * i);
                text << "\n";
            }
    return text.str() + extra;
}

} // namespace

TEST_CASE("measured: the nearest cell is that of the format's definition") {
    MerlFile file = plasticFile();
    for (size_t i = 0; i < file.values.size(); i++)
        if (file.values[i] >= 0) file.values[i] = double(i % 1458000); // distinct
    const IsotropicTable table = parse(file);
    std::mt19937 random(1);
    int compared = 0;
    for (int i = 0; i < 20000; i++) {
        const vec3 in = randomDirection(random, 0.2f), out = randomDirection(random, 0.2f);
        const dvec3 place = merlPlace(dvec3(in), dvec3(out)), inCell = glm::fract(place);
        // Not where single precision may fall on the other side of a cell's border.
        if (glm::any(glm::lessThan(inCell, dvec3(0.01))) || glm::any(glm::greaterThan(inCell, dvec3(0.99))))
            continue;
        const size_t cell = merlCell(int(place.x), int(place.y), int(place.z));
        REQUIRE(table.nearest(in, out).x == float(double(cell) / 1500));
        REQUIRE(table.nearest(in, out).z == float(double(cell) * (1.66 / 1500)));
        compared++;
    }
    CHECK(compared > 15000);
}

TEST_CASE("measured: lookups of an analytic BRDF return it") {
    const IsotropicTable table = parse(plasticFile());
    const auto exact = makeBrdf("red-plastic");
    std::mt19937 random(2);
    double error = 0, total = 0;
    for (int i = 0; i < 20000; i++) {
        const vec3 in = randomDirection(random, 0.05f), out = randomDirection(random, 0.05f);
        const vec3 expected = exact->evaluate(in, out), found = table.interpolate(in, out);
        error += double(std::abs(found.x - expected.x));
        total += double(expected.x);
        REQUIRE(std::abs(found.x - expected.x) <= 0.05f * expected.x + 0.01f);
    }
    CHECK(error / total < 2e-3);
}

TEST_CASE("measured: measured data is reciprocal, to the bit") {
    const test::TemporaryFolder folder;
    folder.write("plastic.binary", plasticFile().bytes());
    const auto brdf = makeBrdf(R"({"measured": "plastic.binary"})", folder.path());
    CHECK(brdf->isReciprocal());
    std::mt19937 random(3);
    std::vector<vec3> directions = {
        {0, 0, 1}, {1, 0, 1e-30f}, {-1, 0, 1e-30f}, {0, 1, 1e-8f}, {0.6f, 0, 0.8f}};
    for (int i = 0; i < 100; i++) directions.push_back(randomDirection(random, 0));
    for (const vec3& a : directions)
        for (const vec3& b : directions) {
            const vec3 value = brdf->evaluate(a, b);
            REQUIRE(value == brdf->evaluate(b, a));
            REQUIRE(glm::all(glm::greaterThanEqual(value, vec3(0))));
            REQUIRE(glm::all(glm::lessThan(value, vec3(1e6f))));
            REQUIRE(brdf->evaluateBase(a, b) == vec3(0));
        }
}

TEST_CASE("measured: a description names the file by path and content") {
    const test::TemporaryFolder folder;
    const auto path = folder.write("plastic.binary", plasticFile().bytes());
    const auto brdf = makeBrdf(R"({"measured": "plastic.binary", "scale": 0.5})", folder.path());
    const nlohmann::json description = brdf->describe();
    CHECK(description["measured"] == path.generic_string());
    CHECK(description["hash"].get<std::string>().size() == 32);
    const vec3 a(0.6f, 0, 0.8f), b(0, 0.6f, 0.8f);
    CHECK(makeBrdf(description.dump())->evaluate(a, b) == brdf->evaluate(a, b));
    const auto whole = makeBrdf(path.string());
    CHECK(whole->evaluate(a, b).x == doctest::Approx(2 * brdf->evaluate(a, b).x));

    std::filesystem::create_directory(folder.path() / "materials");
    folder.write("materials/half.json", R"({"measured": "../plastic.binary", "scale": 0.5})");
    CHECK(makeBrdf("materials/half.json", folder.path())->evaluate(a, b) == brdf->evaluate(a, b));
    folder.write("gold.json", R"({"model": "ggx", "f0": 0.5})");
    CHECK(makeBrdf((folder.path() / "gold.json").string())->describe()["model"] == "ggx");

    folder.write("plastic.binary", cornellText([](double) { return 0.1; }));
    CHECK(says(errorOf(description.dump()), "hash"));
}

TEST_CASE("measured: negative values are counted, reported and filled from their neighbors") {
    MerlFile file = plasticFile();
    for (int p = 20; p < 40; p++)
        for (int d = 10; d < 13; d++) file.at(1, 40, d, p) = -1;
    const test::LogCapture log;
    const IsotropicTable table = parse(file);
    CHECK(log.says("60 of them above the horizon"));
    const IsotropicTable whole = parse(plasticFile());
    for (int p = 20; p < 40; p++)
        for (int d = 10; d < 13; d++)
            CHECK(table[merlCell(40, d, p)].y == doctest::Approx(whole[merlCell(40, d, p)].y).epsilon(0.1));
    for (size_t cell = 0; cell < table.cellCount(); cell++) REQUIRE(table[cell].y >= 0);
}

TEST_CASE("measured: one cell fills a table that lacks all others, layer by layer") {
    IsotropicTable table(90, 90, 180);
    std::vector<bool> isMissing(table.cellCount(), true);
    const size_t known = table.cell(40, 30, 20);
    isMissing[known] = false;
    table[known] = vec3(7, 5, 3);
    fillMissing(table, isMissing); // at once: looking at every cell for every layer would take seconds
    for (size_t cell = 0; cell < table.cellCount(); cell++) REQUIRE(table[cell] == vec3(7, 5, 3));
}

TEST_CASE("measured: noise beyond 80 degrees is held to what a mirror could do") {
    MerlFile file = plasticFile();
    const IsotropicTable clean = parse(file);
    size_t noisy = 0;
    for (int h = 0; h < 40; h++)
        for (int d = 0; d < 90; d++)
            for (int p = 0; p < 180; p++) {
                const auto [wi, wo] = directionsOf(clean.centerOf(h, d, p));
                if (std::min(wi.z, wo.z) > 0 && std::min(wi.z, wo.z) < 0.17f)
                    file.at(0, h, d, p) *= 100, noisy++;
            }
    const test::LogCapture log;
    const IsotropicTable table = parse(file);
    CHECK(log.says("beyond 80 degrees were lowered"));
    CHECK(noisy > 10000);
    const vec3 grazing = glm::normalize(vec3(1, 0, 0.09f)), mirror = grazing * vec3(-1, 1, 1);
    CHECK(table.interpolate(grazing, mirror).x < 5 * clean.interpolate(grazing, mirror).x);
    const vec3 a(0.6f, 0, 0.8f);
    CHECK(table.interpolate(a, a) == clean.interpolate(a, a));
}

TEST_CASE("measured: damaged MERL files are refused") {
    const test::TemporaryFolder folder;
    const std::string good = plasticFile().bytes();
    const auto refused = [&](std::string bytes, const std::string& part) {
        folder.write("bad.binary", bytes);
        const std::string error = errorOf("bad.binary", folder.path());
        CAPTURE(error);
        CHECK(says(error, "bad.binary"));
        CHECK(says(error, part));
    };
    refused("", "90, 90, 180");
    refused("90 90 180", "90, 90, 180");
    refused(good.substr(0, 12), "cut short");
    refused(good.substr(0, good.size() - 1), "cut short");
    refused(good + "x", "cut short");
    std::string changed = good;
    changed[0] = 91;
    refused(changed, "90, 90, 180");
    for (double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 1e300}) {
        changed = good;
        std::memcpy(&changed[12 + 800 * 100], &value, sizeof(value));
        refused(changed, "value 10000 ");
    }
    MerlFile empty = plasticFile();
    for (double& value : empty.values) value = -1;
    refused(empty.bytes(), "nothing to use");
}

TEST_CASE("measured: paths that lead nowhere are named") {
    const test::TemporaryFolder folder;
    CHECK(says(errorOf("missing.binary", folder.path()), "missing.binary: measured material not found"));
    CHECK(says(errorOf("missing.json", folder.path()), "missing.json: material file not found"));
    std::filesystem::create_directory(folder.path() / "folder.brdf");
    CHECK(says(errorOf("folder.brdf", folder.path()), "folder.brdf"));
    std::filesystem::create_directory(folder.path() / "folder.json");
    CHECK(says(errorOf("folder.json", folder.path()), "folder.json"));
    folder.write("wrong.json", R"({"model": "plastik"})");
    const std::string wrong = errorOf("wrong.json", folder.path());
    CHECK(says(wrong, "wrong.json"));
    CHECK(says(wrong, "did you mean \"plastic\""));
    folder.write("empty.json", "");
    CHECK(says(errorOf("empty.json", folder.path()), "empty.json"));
    folder.write("name.json", "\"name.json\"");
    CHECK(says(errorOf("name.json", folder.path()), "must be an object"));
    CHECK(says(errorOf(R"({"measured": "a.binary", "scal": 2})"), "did you mean \"scale\""));
    for (const char* material :
         {R"({"measured": ""})", R"({"measured": 3})", R"({"measured": "a\u0000.binary"})",
          R"({"measured": "x.binary", "scale": -1})", R"({"measured": null})", "\xff.binary",
          R"({"measured": "/"})", R"({"measured": "x", "model": "plastic"})"})
        errorOf(material, folder.path());
    errorOf(std::string(100000, 'x') + ".binary");
    errorOf(std::string(4000, 'x') + ".json");
}

TEST_CASE("measured: a flat spectrum is white, in Cornell's format too") {
    const std::vector<float> wavelengths = {400, 450, 500, 520, 560, 600, 650, 700};
    vec3 sum(0);
    for (const vec3& weight : srgbWeights(wavelengths)) sum += weight;
    CHECK(glm::length(sum - vec3(1)) < 1e-5f);
    const IsotropicTable gray = parseCornell(cornellText([](double) { return 0.08; }), "gray.brdf");
    const vec3 a(0.6f, 0, 0.8f), b(0, 0.8f, 0.6f);
    CHECK(glm::length(gray.interpolate(a, b) - vec3(0.08f)) < 1e-5f);
    const IsotropicTable red =
        parseCornell(cornellText([](double w) { return w > 590 ? 0.3 : 0.05; }), "red.brdf");
    CHECK(red.interpolate(a, b).x > 2 * red.interpolate(a, b).y);
}

TEST_CASE("measured: a monochromatic light at 555 nm has the luminance of the CIE observer") {
    // ȳ(555) = 1; the integral of ȳ is 106.86: ten nanometres of light are 10 / 106.86 of white's luminance.
    std::vector<float> wavelengths;
    for (int i = 0; i <= 400; i++) wavelengths.push_back(380 + float(i));
    const std::vector<vec3> weights = srgbWeights(wavelengths);
    vec3 color(0);
    for (size_t i = 170; i < 180; i++) color += weights[i];
    const float luminance = glm::dot(color, vec3(0.2126f, 0.7152f, 0.0722f));
    CHECK(luminance == doctest::Approx(10 / 106.86).epsilon(0.05));
}

TEST_CASE("measured: hostile Cornell text is refused with its line") {
    const auto flat = [](double) { return 0.1; };
    const auto refused = [&](const std::string& text, const std::string& part) {
        try {
            parseCornell(text, "bad.brdf");
            FAIL("accepted");
        } catch (const Error& error) {
            const std::string message = error.what();
            CAPTURE(message);
            CHECK(says(message, "bad.brdf"));
            CHECK(says(message, part));
        }
    };
    const std::string last = "line 153: "; // after 8 lines of header and 144 samples
    refused("", "0 samples");
    refused("# nothing\n", "0 samples");
    refused("31\n", "0 samples");
    refused("3.5\n", "line 1: expected the number of wavelengths");
    refused("1e30\n", "line 1: expected the number of wavelengths");
    refused("3\n400 500 500\n", "line 2: expected wavelengths");
    refused("3\n400 500 600 700\n", "line 2: more wavelengths");
    refused("3\n500 510 700\n", "line 2: the wavelengths must reach");
    refused(std::string("\x7f\x45LF\x01\x00\x02", 7), "line 1: expected a finite number");
    const std::string values = [] {
        std::string text;
        for (int i = 0; i < 31; i++) text += " 0.1";
        return text;
    }();
    refused(cornellText(flat, "0.1 0.2 0.3 nan" + values + "\n"), last + "expected a finite number");
    refused(cornellText(flat, "0.1 0.2 0.3 0.4\n"), last + "expected four angles");
    refused(cornellText(flat, "1.7 0.2 0.3 0.4" + values + "\n"), last + "expected an angle");
    refused(cornellText(flat, "-0.1 0.2 0.3 0.4" + values + "\n"), last + "expected an angle");
    refused(cornellText(flat, "0.1 0.2 0.3 1e9" + values + "\n"), last + "expected an azimuth");
    refused(cornellText(flat, "0.1 0.2 0.3 0.4 1e30" + values.substr(4) + "\n"),
            last + "expected values up to");
    refused(cornellText([](double) { return -0.1; }), "no sample has a positive value");
    const test::LogCapture log;
    const auto table =
        parseCornell(cornellText(flat, "0.1 0.2 0.3 0.4 -1" + values.substr(4) + "\n"), "x.brdf");
    CHECK(log.says("1 values are negative"));
    CHECK(table.interpolate({0, 0, 1}, {0, 0, 1}).x > 0);
}
