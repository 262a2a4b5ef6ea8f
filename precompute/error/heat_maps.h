// Errors as pictures.
#pragma once

#include "precompute/error/error_study.h"

namespace relume {

// How far each point's radiance is from the truth, or what a source changes of it: length of the difference
// over its channels, in heatColor(), of which 1 is `full`; with every pixel `scale` pixels a side. For PNG
// (display values).
Image totalHeatMap(const ErrorStudy& study, const ViewPoints& points, double full, int scale);
Image sourceHeatMap(const ErrorStudy& study, const ViewPoints& points, ErrorSource source, double full,
                    int scale);

// What to show in full heat: the difference from the truth that one point in a hundred exceeds.
double fullHeat(const ErrorStudy& study);

// Every pixel `scale` pixels a side.
Image enlarged(const Image& image, int scale);

} // namespace relume
