// Figures as SVG: well formed, finite, the same every time.
#include "apps/plot/line_plot.h"
#include "apps/plot/svg.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace relume;

namespace {

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

size_t countOf(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) count++;
    return count;
}

LinePlot samplePlot(bool logarithmic) {
    const PlotCurve falling{"a < b & \"c\"", 0, false, {{1, 0.5}, {2, 0.1}, {3, 0.02}}};
    const PlotCurve broken{"broken", 1, true, {{1, NAN}, {2, INFINITY}, {3, 0}, {4, 0.3}}};
    return {"<title>", "x", "y", {0, 2, 4}, logarithmic, 2, {{"one", {falling, broken}}, {"two", {falling}}}};
}

} // namespace

TEST_CASE("line plot: markup in text is escaped, whatever is not finite left out") {
    for (const bool logarithmic : {false, true}) {
        const std::string svg = drawLinePlot(samplePlot(logarithmic));
        CHECK(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
        CHECK(svg.ends_with("</svg>\n"));
        CHECK(says(svg, "&lt;title&gt;"));
        CHECK(says(svg, "a &lt; b &amp; &quot;c&quot;"));
        for (const char* part : {"nan", "inf", "e+", "<title>"}) CHECK_FALSE(says(svg, part));
        CHECK_EQ(countOf(svg, "<text"), countOf(svg, "</text>"));
        CHECK_EQ(drawLinePlot(samplePlot(logarithmic)), svg);
    }
}

TEST_CASE("line plot: a name stands once in the legend, ticks cover the values") {
    const std::string svg = drawLinePlot(samplePlot(true));
    CHECK_EQ(countOf(svg, "&quot;c&quot;"), 1u);
    for (const char* tick : {">0.02<", ">0.05<", ">0.1<", ">0.5<"}) CHECK(says(svg, tick));
    CHECK_FALSE(says(svg, ">0.01<"));
    for (const char* tick : {">0<", ">0.1<", ">0.5<"}) CHECK(says(drawLinePlot(samplePlot(false)), tick));
}

TEST_CASE("line plot: decades are as wide as each other on a logarithmic x axis") {
    LinePlot plot{
        "", "x", "y", {1, 10, 100}, false, 1, {{"", {{"curve", 0, false, {{1, 1}, {10, 1}, {100, 1}}}}}}};
    const auto ends = [&] {
        const std::string svg = drawLinePlot(plot);
        const size_t start = svg.find("<polyline points=\"", svg.find("<polyline") + 1);
        REQUIRE(start != std::string::npos);
        double x[3], y;
        REQUIRE(std::sscanf(svg.c_str() + start, "<polyline points=\"%lf,%lf %lf,%lf %lf", &x[0], &y, &x[1],
                            &y, &x[2]) == 5);
        return (x[1] - x[0]) / (x[2] - x[0]);
    };
    CHECK(ends() == doctest::Approx(0.0909).epsilon(0.01));
    plot.logarithmicX = true;
    CHECK(ends() == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("line plot: nothing to draw is drawn") {
    LinePlot empty{"none", "x", "y", {0, 1}, true, 1, {{"", {{"curve", 0, false, {}}}}}};
    CHECK(drawLinePlot(empty).ends_with("</svg>\n"));
    CHECK_FALSE(says(drawLinePlot(empty), "points=\"\""));
    empty.panels.clear();
    CHECK(drawLinePlot(empty).ends_with("</svg>\n"));
}

TEST_CASE("svg: control characters, which XML lacks, become spaces") {
    Svg svg(10, 10);
    svg.text({0, 0},
             "a\x01"
             "b\nc",
             {});
    CHECK(says(svg.finish(), ">a b c<"));
}
