#include "precompute/error/heat_maps.h"

#include "engine/render/compare.h"
#include "engine/render/tone_map.h"

#include <algorithm>

namespace relume {

namespace {

double changeOf(const StageRadiance& stages, size_t from, size_t to) {
    return glm::length(glm::dvec3(stages[from]) - glm::dvec3(stages[to]));
}

// Returns the 99th percentile of the differences from the truth.
double fullHeat(const ErrorStudy& study) {
    std::vector<double> changes;
    for (const StageRadiance& stages : study.stages) changes.push_back(changeOf(stages, 0, kErrorSources));
    if (changes.empty()) return 0;
    const auto place = changes.begin() + std::ptrdiff_t(changes.size() * 99 / 100);
    std::nth_element(changes.begin(), place, changes.end());
    return *place;
}

} // namespace

std::vector<HeatMap> heatMaps(const ErrorStudy& study, const ViewPoints& points, int scale) {
    const double full = fullHeat(study);
    const auto between = [&](size_t from, size_t to) {
        const Image map = points.image([&](size_t i) {
            const double heat = full > 0 ? changeOf(study.stages[i], from, to) / full : 0;
            return heatColor(float(heat));
        });
        return toneMap(enlarged(map, scale), ToneCurve::None, 0);
    };
    std::vector<HeatMap> maps = {{"total", between(0, kErrorSources)}};
    for (size_t i = 0; i < kErrorSources; i++)
        maps.push_back({std::string(errorSourceName(ErrorSource(i))), between(i, i + 1)});
    return maps;
}

Image enlarged(const Image& image, int scale) {
    Image large(image.width * scale, image.height * scale);
    for (int y = 0; y < large.height; y++)
        for (int x = 0; x < large.width; x++) large.at(x, y) = image.at(x / scale, y / scale);
    return large;
}

} // namespace relume
