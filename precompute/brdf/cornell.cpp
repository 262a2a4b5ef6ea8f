#include "precompute/brdf/cornell.h"

#include "engine/base/error.h"
#include "engine/base/log.h"
#include "precompute/brdf/cornell_text.h"
#include "precompute/brdf/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// Fewer cells than a MERL table has, since some thousand samples determine no more.
constexpr int kHalves = 60, kDifferences = 30, kTableAzimuths = 36;
constexpr size_t kNeighbors = 12;
// How much faster a BRDF varies with √θh than with θd, and with φd.
constexpr float kHalfWeight = 4, kAzimuthWeight = 1;

struct Point {
    vec4 position;
    vec3 logarithm;
};

// Maps angles to a point such that distances are meaningful: φd = 0 and φd = π coincide, and φd has no effect
// where θh = 0 or θd = 0.
vec4 positionOf(const HalfDifference& angles) {
    const float half = std::sqrt(angles.half * (2 / kPi)), difference = angles.difference * (2 / kPi);
    const float radius = kAzimuthWeight * half * difference;
    return {kHalfWeight * half, difference, radius * std::cos(2 * angles.azimuth),
            radius * std::sin(2 * angles.azimuth)};
}

vec3 directionAt(float theta, float phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

vec3 colorOf(const CornellSample& sample, const std::vector<vec3>& weights, size_t& negative) {
    vec3 color(0);
    for (size_t i = 0; i < weights.size(); i++) {
        negative += sample.values[i] < 0;
        color += weights[i] * std::max(sample.values[i], 0.0f);
    }
    return color;
}

// Returns the samples and their mirror images in the plane of incidence.
std::vector<Point> pointsOf(const CornellText& text, const std::string& name) {
    const std::vector<vec3> weights = srgbWeights(text.wavelengths);
    std::vector<vec3> colors;
    size_t negativeValues = 0, outsideGamut = 0;
    std::vector<float> brightness;
    for (const CornellSample& sample : text.samples) {
        const vec3 color = colorOf(sample, weights, negativeValues);
        outsideGamut += std::min({color.x, color.y, color.z}) < 0;
        colors.push_back(glm::max(color, vec3(0)));
        brightness.push_back(std::max({color.x, color.y, color.z}));
    }
    std::sort(brightness.begin(), brightness.end());
    if (!(brightness.back() > 0))
        throw Error(fmt::format("{}: no sample has a positive value; nothing to use", name));
    log(LogLevel::Info,
        fmt::format(
            "{}: {} samples of {} wavelengths; {} values are negative ({:.2f} %), {} colors lie outside "
            "sRGB ({:.2f} %): taken as zero in the channel",
            name, text.samples.size(), weights.size(), negativeValues,
            100 * double(negativeValues) / double(text.samples.size() * weights.size()), outsideGamut,
            100 * double(outsideGamut) / double(text.samples.size())));
    // Zero has no logarithm, so values are at least a thousandth of the median sample.
    const vec3 floor(std::max(1e-3f * brightness[brightness.size() / 2], 1e-9f * brightness.back()));
    std::vector<Point> points;
    for (size_t i = 0; i < colors.size(); i++) {
        const auto& [thetaIn, phiIn, thetaOut, phiOut] = text.samples[i].angles;
        const vec3 logarithm = glm::log(glm::max(colors[i], floor));
        HalfDifference angles = halfDifference(directionAt(thetaIn, phiIn), directionAt(thetaOut, phiOut));
        points.push_back({positionOf(angles), logarithm});
        angles.azimuth = -angles.azimuth;
        points.push_back({positionOf(angles), logarithm});
    }
    return points;
}

// Interpolates with Shepard's weights ((R - d) / d)² of the points nearest to `position`, where R is the
// distance of the next nearest.
vec3 interpolate(const std::vector<Point>& points, vec4 position) {
    struct Near {
        float squared;
        size_t point;
    };
    std::array<Near, kNeighbors + 1> nearest;
    nearest.fill({INFINITY, 0});
    for (size_t i = 0; i < points.size(); i++) {
        const vec4 apart = points[i].position - position;
        const float squared = glm::dot(apart, apart);
        if (squared >= nearest.back().squared) continue;
        size_t place = kNeighbors;
        for (; place > 0 && nearest[place - 1].squared > squared; place--)
            nearest[place] = nearest[place - 1];
        nearest[place] = {squared, i};
    }
    const float radius = std::sqrt(nearest.back().squared) + 1e-6f;
    vec3 sum(0);
    float total = 0;
    for (size_t i = 0; i < kNeighbors; i++) {
        const float distance = std::max(std::sqrt(nearest[i].squared), 1e-6f);
        const float ratio = (radius - distance) / distance, weight = ratio * ratio + 1e-6f;
        sum += points[nearest[i].point].logarithm * weight;
        total += weight;
    }
    return glm::exp(sum / total);
}

} // namespace

IsotropicTable parseCornell(std::string_view text, const std::string& name) {
    const std::vector<Point> points = pointsOf(readCornellText(text, name), name);
    IsotropicTable table(kHalves, kDifferences, kTableAzimuths);
    tbb::parallel_for(0, kHalves, [&](int half) {
        for (int difference = 0; difference < kDifferences; difference++)
            for (int azimuth = 0; azimuth < kTableAzimuths; azimuth++)
                table[table.cell(half, difference, azimuth)] =
                    interpolate(points, positionOf(table.centerOf(half, difference, azimuth)));
    });
    return table;
}

} // namespace relume
