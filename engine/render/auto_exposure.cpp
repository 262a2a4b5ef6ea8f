#include "engine/render/auto_exposure.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

constexpr double kKey = 0.3; // middle gray is 0.18; grounds are mostly white
constexpr double kBrightShare = 0.02;
constexpr float kDarkest = 1e-3f; // relative to the brightest that counts in full
constexpr double kMostStops = 20;

struct Sample {
    float luminance, alpha;
};

} // namespace

float autoExposure(const Image& image) {
    std::vector<Sample> samples;
    double covered = 0;
    for (const vec4& pixel : image.pixels) {
        const float light = glm::dot(vec3(pixel), vec3(0.2126f, 0.7152f, 0.0722f));
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
