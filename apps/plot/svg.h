// A drawing as a standalone SVG file: lines, areas and text on white, so that it reads on any background. The
// same calls give the same bytes.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>

namespace relume {

struct LineStyle {
    std::string_view colour = "#444444";
    double width = 1;
    std::string_view dashes = ""; // "4 3", SVG's stroke-dasharray; empty: solid
};

enum class Anchor { Start, Middle, End };

struct TextStyle {
    double size = 11;
    Anchor anchor = Anchor::Start;
    bool bold = false, upwards = false; // upwards: turned by a quarter, to be read from the right
    std::string_view colour = "#222222";
};

// Places are in pixels from the top left, finite.
class Svg {
  public:
    Svg(double width, double height);

    void line(glm::dvec2 from, glm::dvec2 to, const LineStyle& stroke);
    void polyline(std::span<const glm::dvec2> points, const LineStyle& stroke);
    void polygon(std::span<const glm::dvec2> points, std::string_view fill);
    // `text` is UTF-8; what SVG would take for markup is escaped.
    void text(glm::dvec2 place, std::string_view text, const TextStyle& style);
    // A circle's upper half, about `centre`.
    void halfCircle(glm::dvec2 centre, double radius, const LineStyle& stroke);

    std::string finish() const;

  private:
    std::string mBody;
};

// The colours of curves, told apart by any eye: Okabe and Ito's, their yellow replaced.
std::string_view curveColour(size_t index);

} // namespace relume
