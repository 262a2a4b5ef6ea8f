// Draws errors as heat maps.
#pragma once

#include "precompute/error/error_study.h"

namespace relume {

struct HeatMap {
    std::string name; // "total", or the name of a source
    Image map;        // display values, for PNG
};

// Returns maps of every point's difference from the truth, and of its change by every source: the length of
// the difference over channels, in heatColor(), with `scale` × `scale` pixels per point. Full heat is, in all
// maps, the 99th percentile of the differences from the truth.
std::vector<HeatMap> heatMaps(const ErrorStudy& study, const ViewPoints& points, int scale);

// Returns the image with every pixel repeated `scale` × `scale` times.
Image enlarged(const Image& image, int scale);

} // namespace relume
