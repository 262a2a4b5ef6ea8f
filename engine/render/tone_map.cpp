#include "engine/render/tone_map.h"

#include "engine/math/color.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// Brighter than any value that a curve distinguishes from white; its square is a finite float.
constexpr float kBrightest = 1e15f;

vec3 aces(vec3 x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

// Returns linear display light. AgX works on logarithms, in primaries that are drawn in towards white.
vec3 agx(vec3 x) {
    static const mat3 inset(0.842479062253094f, 0.0423282422610123f, 0.0423756549057051f, // by columns
                            0.0784335999999992f, 0.878468636469772f, 0.0784336f, 0.0792237451477643f,
                            0.0791661274605434f, 0.879142973793104f),
        outset = glm::inverse(inset);
    constexpr float kLowestStop = -12.47393f, kHighestStop = 4.026069f;
    const vec3 stops = glm::log2(glm::max(inset * x, vec3(1e-10f)));
    const vec3 t = glm::clamp((stops - kLowestStop) / (kHighestStop - kLowestStop), vec3(0), vec3(1));
    const vec3 t2 = t * t, t4 = t2 * t2;
    const vec3 contrast = 15.5f * t4 * t2 - 40.14f * t4 * t + 31.96f * t4 - 6.868f * t2 * t + 0.4298f * t2 +
                          0.1191f * t - 0.00232f;
    // The sigmoid is meant for a display of gamma 2.2.
    return glm::pow(glm::max(outset * contrast, vec3(0)), vec3(2.2f));
}

float exposed(float value, float scale) {
    const float x = value * scale;
    return x > 0 ? std::min(x, kBrightest) : 0.0f;
}

constexpr double kKey = 0.3; // middle gray is 0.18; grounds are mostly white
constexpr double kBrightShare = 0.02;
constexpr float kDarkest = 1e-3f; // relative to the brightest that counts in full
constexpr double kMostStops = 20;

struct Sample {
    float luminance, alpha;
};

} // namespace

Image toneMap(const Image& linear, ToneCurve curve, float exposureStops) {
    Image display = linear;
    const float scale = std::exp2(exposureStops);
    for (vec4& pixel : display.pixels) {
        vec3 x(exposed(pixel.x, scale), exposed(pixel.y, scale), exposed(pixel.z, scale));
        if (curve == ToneCurve::Aces) x = aces(x);
        if (curve == ToneCurve::Agx) x = agx(x);
        for (int c = 0; c < 3; c++) pixel[c] = std::clamp(encodeSrgb(x[c]), 0.0f, 1.0f);
    }
    return display;
}

std::optional<ToneCurve> toneCurveFromName(std::string_view name) {
    if (name == "none") return ToneCurve::None;
    if (name == "aces") return ToneCurve::Aces;
    if (name == "agx") return ToneCurve::Agx;
    return std::nullopt;
}

float autoExposure(const Image& image) {
    std::vector<Sample> samples;
    double covered = 0;
    for (const vec4& pixel : image.pixels) {
        const float light = luminance(vec3(pixel));
        if (!(pixel.w > 0) || !std::isfinite(light)) continue;
        samples.push_back({std::max(light, 0.0f) / pixel.w, pixel.w});
        covered += double(pixel.w);
    }
    std::ranges::sort(samples, std::greater(), &Sample::luminance);
    double above = 0;
    const auto bright = std::ranges::find_if(samples, [&](const Sample& sample) {
        above += double(sample.alpha);
        return above > kBrightShare * covered;
    });
    if (bright == samples.end() || !(bright->luminance > 0)) return 0;
    const float most = bright->luminance;
    double sum = 0, weight = 0;
    for (const Sample& sample : samples) {
        if (sample.luminance < kDarkest * most) break;
        sum += double(sample.alpha) * std::log2(double(std::min(sample.luminance, most)));
        weight += double(sample.alpha);
    }
    const double stops = std::log2(kKey) - sum / weight;
    return float(std::round(100 * std::clamp(stops, -kMostStops, kMostStops)) / 100);
}

} // namespace relume
