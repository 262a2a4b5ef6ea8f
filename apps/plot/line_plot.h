// Curves over a common abscissa, one panel or many, as SVG.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace relume {

struct PlotCurve {
    std::string name;  // in the legend; curves of one name in several panels look the same and appear once
    size_t colour = 0; // of curveColour()
    bool dashed = false;
    // Those that are not finite, or not above 0 on a logarithmic axis, are left out.
    std::vector<glm::dvec2> points;
};

struct PlotPanel {
    std::string title;
    std::vector<PlotCurve> curves;
};

struct LinePlot {
    std::string title, xLabel, yLabel;
    std::vector<double> xTicks; // the axis goes from the first to the last; two or more
    bool logarithmic = false;   // y; else from 0
    int columns = 1;            // of panels
    std::vector<PlotPanel> panels;
    bool logarithmicX = false; // x, whose ticks are then above 0
};

// Panels of one range of y, so that they compare.
std::string drawLinePlot(const LinePlot& plot);

} // namespace relume
