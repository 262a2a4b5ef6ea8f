#include "precompute/error/heat_maps.h"

#include "engine/render/heat_color.h"
#include "engine/render/tone_map.h"

#include <algorithm>

namespace relume {

namespace {

double changeOf(const StageRadiance& stages, size_t from, size_t to) {
    return glm::length(glm::dvec3(stages[from]) - glm::dvec3(stages[to]));
}

Image heatMap(const ErrorStudy& study, const ViewPoints& points, size_t from, size_t to, double full,
              int scale) {
    const Image map = points.image([&](size_t i) {
        const double heat = full > 0 ? changeOf(study.stages[i], from, to) / full : 0;
        return heatColor(float(heat));
    });
    return toneMap(enlarged(map, scale), ToneCurve::None, 0);
}

} // namespace

Image totalHeatMap(const ErrorStudy& study, const ViewPoints& points, double full, int scale) {
    return heatMap(study, points, 0, kErrorSources, full, scale);
}

Image sourceHeatMap(const ErrorStudy& study, const ViewPoints& points, ErrorSource source, double full,
                    int scale) {
    return heatMap(study, points, size_t(source), size_t(source) + 1, full, scale);
}

double fullHeat(const ErrorStudy& study) {
    std::vector<double> changes;
    for (const StageRadiance& stages : study.stages) changes.push_back(changeOf(stages, 0, kErrorSources));
    if (changes.empty()) return 0;
    const auto place = changes.begin() + std::ptrdiff_t(changes.size() * 99 / 100);
    std::nth_element(changes.begin(), place, changes.end());
    return *place;
}

Image enlarged(const Image& image, int scale) {
    Image large(image.width * scale, image.height * scale);
    for (int y = 0; y < large.height; y++)
        for (int x = 0; x < large.width; x++) large.at(x, y) = image.at(x / scale, y / scale);
    return large;
}

} // namespace relume
