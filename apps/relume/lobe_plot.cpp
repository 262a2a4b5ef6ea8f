#include "apps/relume/lobe_plot.h"

#include "apps/plot/svg.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace relume {

namespace {

using glm::dvec2;

constexpr double kRadius = 190, kPanelWidth = 2 * kRadius + 70, kPanelHeight = kRadius + 78, kTop = 66;
constexpr float kIncoming[] = {0, 30, 60, 80}; // degrees
constexpr int kSteps = 360;                    // of half a degree each
constexpr LineStyle kTrue{"#0072b2", 2}, kApproximated{"#d55e00", 2, "6 4"}, kGrid{"#dddddd", 1},
    kHorizon{"#888888", 1}, kRay{"#444444", 1.5};

// In the plane of s and the normal; positive angles lean towards s.
vec3 directionAt(float degrees) {
    const float angle = degrees * kPi / 180;
    return liftAboveHorizon({std::sin(angle), 0, std::cos(angle)});
}

float angleOf(int step) { return -90 + 180 * float(step) / kSteps; }

double luminance(vec3 colour) { return double(glm::dot(colour, vec3(0.2126f, 0.7152f, 0.0722f))); }

dvec2 onPlot(dvec2 centre, float degrees, double radius) {
    const double angle = double(degrees * kPi / 180);
    return centre + radius * dvec2(std::sin(angle), -std::cos(angle));
}

// Values over the outgoing angle, as a curve about the centre.
void drawLobe(Svg& svg, dvec2 centre, const std::vector<double>& values, double largest,
              const LineStyle& stroke) {
    std::vector<dvec2> points;
    for (int step = 0; step <= kSteps; step++)
        points.push_back(
            onPlot(centre, angleOf(step), kRadius * std::min(values[size_t(step)] / largest, 1.15)));
    svg.polyline(points, stroke);
}

// An arrow along the light, down to the point it hits.
void drawRay(Svg& svg, dvec2 centre, float degrees) {
    const dvec2 from = onPlot(centre, degrees, kRadius + 12), tip = onPlot(centre, degrees, kRadius - 26);
    svg.line(from, tip, kRay);
    const dvec2 along = glm::normalize(tip - from), across(-along.y, along.x);
    const dvec2 head[] = {tip + 7.0 * along, tip + 4.0 * across, tip - 4.0 * across};
    svg.polygon(head, kRay.colour);
}

void drawPanel(Svg& svg, dvec2 centre, float incomingAngle, const Brdf& brdf, const FactoredBrdf& factored) {
    const vec3 incoming = directionAt(-incomingAngle);
    std::vector<double> exact, approximated;
    for (int step = 0; step <= kSteps; step++) {
        const vec3 outgoing = directionAt(angleOf(step));
        exact.push_back(double(outgoing.z) * luminance(brdf.evaluate(incoming, outgoing)));
        const vec3 sum = glm::max(evaluate(factored, incoming, outgoing), vec3(0));
        approximated.push_back(double(outgoing.z) * luminance(sum));
    }
    const double peak = *std::max_element(exact.begin(), exact.end());
    const double largest = peak > 0 ? peak : 1;
    for (const double part : {0.5, 1.0}) svg.halfCircle(centre, part * kRadius, kGrid);
    for (const float angle : {-60.0f, -30.0f, 0.0f, 30.0f, 60.0f})
        svg.line(centre, onPlot(centre, angle, kRadius), kGrid);
    svg.line(centre - dvec2(kRadius, 0), centre + dvec2(kRadius, 0), kHorizon);
    for (const double part : {0.5, 1.0})
        svg.text(centre + dvec2(part * kRadius, 14), fmt::format("{:.3g}", part * largest),
                 {.size = 10, .anchor = Anchor::Middle, .colour = "#777777"});
    drawLobe(svg, centre, exact, largest, kTrue);
    drawLobe(svg, centre, approximated, largest, kApproximated);
    drawRay(svg, centre, -incomingAngle);
    svg.text(centre + dvec2(0, 32), fmt::format("light at {:g}°", incomingAngle),
             {.size = 12, .anchor = Anchor::Middle, .bold = true});
}

} // namespace

std::string drawLobes(const Brdf& brdf, const FactoredBrdf& factored, const std::string& title) {
    constexpr int kColumns = 2, kRows = 2;
    Svg svg(kColumns * kPanelWidth, kTop + kRows * kPanelHeight);
    svg.text({24, 26}, title, {.size = 15, .bold = true});
    svg.text({24, 46}, "f cos θo over the outgoing angle, in the plane of normal and s (sr⁻¹)", {});
    const double right = kColumns * kPanelWidth - 24;
    svg.line({right - 290, 42}, {right - 262, 42}, kTrue);
    svg.text({right - 256, 46}, "BRDF", {});
    svg.line({right - 200, 42}, {right - 172, 42}, kApproximated);
    svg.text({right - 166, 46},
             fmt::format("K = {}, {} x {} texels", factored.terms, factored.size, factored.size), {});
    for (int i = 0; i < kColumns * kRows; i++) {
        const dvec2 centre((i % kColumns + 0.5) * kPanelWidth, kTop + (i / kColumns + 1) * kPanelHeight - 46);
        drawPanel(svg, centre, kIncoming[i], brdf, factored);
    }
    return svg.finish();
}

} // namespace relume
