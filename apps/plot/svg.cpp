#include "apps/plot/svg.h"

#include "apps/plot/markup.h"
#include "engine/base/check.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace relume {

namespace {

// To a hundredth of a pixel, without trailing zeros or a negative zero.
std::string number(double value) {
    RELUME_CHECK(std::isfinite(value));
    const double rounded = std::round(value * 100) / 100;
    return fmt::format("{}", rounded == 0 ? 0.0 : rounded);
}

std::string attributes(const LineStyle& stroke) {
    const std::string dashes =
        stroke.dashes.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", stroke.dashes);
    return fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}", stroke.colour,
                       number(stroke.width), dashes);
}

std::string listed(std::span<const glm::dvec2> points) {
    std::string list;
    for (const glm::dvec2& point : points)
        list += fmt::format("{}{},{}", list.empty() ? "" : " ", number(point.x), number(point.y));
    return list;
}

} // namespace

Svg::Svg(double width, double height)
    : mBody(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                        "viewBox=\"0 0 {0} {1}\" stroke=\"none\" font-family=\"Helvetica, Arial, 'DejaVu "
                        "Sans', sans-serif\">\n"
                        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                        number(width), number(height))) {}

void Svg::line(glm::dvec2 from, glm::dvec2 to, const LineStyle& stroke) {
    mBody += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", number(from.x),
                         number(from.y), number(to.x), number(to.y), attributes(stroke));
}

void Svg::polyline(std::span<const glm::dvec2> points, const LineStyle& stroke) {
    mBody += fmt::format("<polyline points=\"{}\" {} stroke-linejoin=\"round\"/>\n", listed(points),
                         attributes(stroke));
}

void Svg::polygon(std::span<const glm::dvec2> points, std::string_view fill) {
    mBody += fmt::format("<polygon points=\"{}\" fill=\"{}\"/>\n", listed(points), fill);
}

void Svg::text(glm::dvec2 place, std::string_view text, const TextStyle& style) {
    constexpr std::array kAnchors = {"start", "middle", "end"};
    mBody += fmt::format("<text transform=\"translate({} {}){}\" font-size=\"{}\" text-anchor=\"{}\" "
                         "fill=\"{}\"{}>{}</text>\n",
                         number(place.x), number(place.y), style.upwards ? " rotate(-90)" : "",
                         number(style.size), kAnchors[size_t(style.anchor)], style.colour,
                         style.bold ? " font-weight=\"bold\"" : "", escapedMarkup(text));
}

void Svg::halfCircle(glm::dvec2 centre, double radius, const LineStyle& stroke) {
    mBody += fmt::format("<path d=\"M {0} {1} A {2} {2} 0 0 1 {3} {1}\" {4}/>\n", number(centre.x - radius),
                         number(centre.y), number(radius), number(centre.x + radius), attributes(stroke));
}

std::string Svg::finish() const { return mBody + "</svg>\n"; }

std::string_view curveColour(size_t index) {
    constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                     "#e69f00", "#56b4e9", "#6a3d9a", "#555555"};
    return kColours[index % kColours.size()];
}

} // namespace relume
