#include "apps/plot/line_plot.h"

#include "apps/plot/svg.h"
#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

using glm::dvec2;

constexpr double kLeft = 64, kRight = 16, kTop = 34, kLegendRow = 18, kBottom = 46;
constexpr double kGapX = 22, kGapY = 30, kLetterWidth = 6.2; // of text of 11 pixels, on average
constexpr LineStyle kGrid{"#e4e4e4", 1}, kFrame{"#888888", 1};

bool isDrawn(const LinePlot& plot, dvec2 point) {
    return std::isfinite(point.x) && std::isfinite(point.y) && (!plot.logarithmic || point.y > 0) &&
           (!plot.logarithmicX || point.x > 0);
}

// The y axis: its ends, its labelled ticks, and where a value lies between the ends.
struct Axis {
    double low = 0, high = 1;
    std::vector<double> ticks;
    bool logarithmic = false;

    double fraction(double value) const {
        if (!logarithmic) return (value - low) / (high - low);
        return std::log(value / low) / std::log(high / low);
    }
};

// 1, 2 or 5 times a power of ten: the largest at or below, or the least at or above `value`.
double roundNumber(double value, bool up) {
    const double decade = std::pow(10, std::floor(std::log10(value)));
    constexpr double kSteps[] = {1, 2, 5, 10};
    const double slack = up ? 1 - 1e-9 : 1 + 1e-9;
    double best = up ? kSteps[3] : kSteps[0];
    for (const double step : kSteps) {
        if (up && step * decade >= value * slack) return step * decade;
        if (!up && step * decade <= value * slack) best = step;
    }
    return best * decade;
}

Axis axisOf(const LinePlot& plot) {
    double least = INFINITY, most = 0;
    for (const PlotPanel& panel : plot.panels)
        for (const PlotCurve& curve : panel.curves)
            for (const dvec2& point : curve.points) {
                if (!isDrawn(plot, point)) continue;
                least = std::min(least, point.y);
                most = std::max(most, point.y);
            }
    Axis axis;
    axis.logarithmic = plot.logarithmic;
    if (!(most > 0)) least = most = 1; // nothing to see
    if (!plot.logarithmic) {
        const double step = roundNumber(most / 5, true);
        axis.high = step * std::ceil(most / step - 1e-9);
        for (int i = 0; i * step <= axis.high * (1 + 1e-9); i++) axis.ticks.push_back(i * step);
        return axis;
    }
    axis.high = roundNumber(most, true);
    // Beyond a millionth of the largest, errors are rounding.
    axis.low = roundNumber(std::max(least, 1e-6 * most), false);
    axis.low = std::min(axis.low, roundNumber(axis.high / 10, false)); // curves that hardly fall look so
    const bool dense = axis.high / axis.low < 3e3;
    for (double tick = axis.low; tick <= axis.high * 1.001; tick = roundNumber(1.01 * tick, true)) {
        const double mantissa = tick / std::pow(10, std::floor(std::log10(tick * 1.001)));
        if (dense || std::abs(mantissa - 1) < 0.01) axis.ticks.push_back(tick);
    }
    return axis;
}

class Panel {
  public:
    Panel(const LinePlot& plot, const Axis& axis, dvec2 corner, dvec2 size)
        : mPlot(plot), mAxis(axis), mCorner(corner), mSize(size) {}

    void draw(Svg& svg, const PlotPanel& panel, bool labelX, bool labelY) const {
        for (const double tick : mPlot.xTicks) {
            const double x = place({tick, mAxis.high}).x;
            svg.line({x, mCorner.y}, {x, mCorner.y + mSize.y}, kGrid);
            if (labelX)
                svg.text({x, mCorner.y + mSize.y + 15}, fmt::format("{:.5g}", tick),
                         {.anchor = Anchor::Middle});
        }
        for (const double tick : mAxis.ticks) {
            const double y = place({mPlot.xTicks[0], tick}).y;
            svg.line({mCorner.x, y}, {mCorner.x + mSize.x, y}, kGrid);
            if (labelY)
                svg.text({mCorner.x - 6, y + 4}, fmt::format("{:.5g}", tick), {.anchor = Anchor::End});
        }
        const dvec2 far = mCorner + mSize;
        const dvec2 frame[] = {mCorner, {far.x, mCorner.y}, far, {mCorner.x, far.y}, mCorner};
        svg.polyline(frame, kFrame);
        if (!panel.title.empty())
            svg.text({mCorner.x + mSize.x / 2, mCorner.y - 7}, panel.title,
                     {.size = 11.5, .anchor = Anchor::Middle, .bold = true});
        for (const PlotCurve& curve : panel.curves) drawCurve(svg, curve);
    }

  private:
    dvec2 place(dvec2 point) const {
        const double first = mPlot.xTicks.front(), last = mPlot.xTicks.back();
        const double right = mPlot.logarithmicX ? std::log(point.x / first) / std::log(last / first)
                                                : (point.x - first) / (last - first);
        // A rare value below a logarithmic axis lies on its end.
        const double up = std::clamp(mAxis.fraction(point.y), 0.0, 1.0);
        return mCorner + dvec2(right * mSize.x, (1 - up) * mSize.y);
    }

    void drawCurve(Svg& svg, const PlotCurve& curve) const {
        std::vector<dvec2> points;
        for (const dvec2& point : curve.points)
            if (isDrawn(mPlot, point)) points.push_back(place(point));
        if (points.empty()) return;
        if (points.size() == 1) points = {points[0] - dvec2(4, 0), points[0] + dvec2(4, 0)}; // to be seen
        svg.polyline(points, {curveColour(curve.colour), 1.7, curve.dashed ? "5 3" : ""});
    }

    const LinePlot& mPlot;
    const Axis& mAxis;
    dvec2 mCorner, mSize;
};

// Every name once, with its place: from the left, a new row where the width ends.
struct LegendEntry {
    const PlotCurve* curve;
    dvec2 place;
};
std::vector<LegendEntry> legendOf(const LinePlot& plot, double width) {
    std::vector<LegendEntry> entries;
    dvec2 place(0);
    for (const PlotPanel& panel : plot.panels)
        for (const PlotCurve& curve : panel.curves) {
            const bool isKnown = std::any_of(entries.begin(), entries.end(), [&](const LegendEntry& entry) {
                return entry.curve->name == curve.name;
            });
            if (isKnown) continue;
            const double entryWidth = 46 + kLetterWidth * double(curve.name.size());
            if (place.x > 0 && place.x + entryWidth > width) place = {0, place.y + kLegendRow};
            entries.push_back({&curve, place});
            place.x += entryWidth;
        }
    return entries;
}

} // namespace

std::string drawLinePlot(const LinePlot& plot) {
    RELUME_CHECK_LE(size_t(2), plot.xTicks.size());
    RELUME_CHECK_LE(1, plot.columns);
    const bool isSingle = plot.panels.size() == 1;
    const dvec2 size = isSingle ? dvec2(620, 360) : dvec2(230, 150);
    const int columns = std::clamp(int(plot.panels.size()), 1, plot.columns);
    const int rows = (int(plot.panels.size()) + columns - 1) / columns;
    const double width = kLeft + columns * size.x + (columns - 1) * kGapX + kRight;
    const std::vector<LegendEntry> legend = legendOf(plot, width - kLeft - kRight);
    const double legendHeight = legend.empty() ? 0 : legend.back().place.y + kLegendRow;
    const double top = kTop + legendHeight + (isSingle && plot.panels[0].title.empty() ? 6 : 24);
    const double height = top + rows * size.y + std::max(rows - 1, 0) * kGapY + kBottom;

    Svg svg(width, height);
    svg.text({kLeft, 24}, plot.title, {.size = 15, .bold = true});
    for (const LegendEntry& entry : legend) {
        const dvec2 at = entry.place + dvec2(kLeft, kTop + 10);
        svg.line(at - dvec2(0, 4), at + dvec2(26, -4),
                 {curveColour(entry.curve->colour), 2, entry.curve->dashed ? "5 3" : ""});
        svg.text(at + dvec2(31, 0), entry.curve->name, {});
    }
    const Axis axis = axisOf(plot);
    for (int i = 0; i < int(plot.panels.size()); i++) {
        const int column = i % columns, row = i / columns;
        const dvec2 corner(kLeft + column * (size.x + kGapX), top + row * (size.y + kGapY));
        const bool isLowest = i + columns >= int(plot.panels.size());
        Panel(plot, axis, corner, size).draw(svg, plot.panels[size_t(i)], isLowest, column == 0);
    }
    svg.text({kLeft + (width - kLeft - kRight) / 2, height - 10}, plot.xLabel,
             {.size = 12, .anchor = Anchor::Middle});
    svg.text({16, top + (height - top - kBottom) / 2}, plot.yLabel,
             {.size = 12, .anchor = Anchor::Middle, .upwards = true});
    return svg.finish();
}

} // namespace relume
