// Errors as pictures.
#pragma once

#include "precompute/error/error_study.h"

namespace relume {

struct HeatMap {
    std::string name; // "total", or that of a source
    Image map;        // display values, for PNG
};

// How far each point's radiance is from the truth, and what every source changes of it: the length of the
// difference over its channels, in heatColor(), with every pixel `scale` pixels a side. Full heat is, in all
// maps alike, the difference from the truth that one point in a hundred exceeds.
std::vector<HeatMap> heatMaps(const ErrorStudy& study, const ViewPoints& points, int scale);

// Every pixel `scale` pixels a side.
Image enlarged(const Image& image, int scale);

} // namespace relume
