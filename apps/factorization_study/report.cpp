#include "apps/factorization_study/report.h"

#include "apps/plot/line_plot.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr int kColumns = 4; // of panels

LinePlot plotOf(std::string title, std::string yLabel) {
    return {std::move(title), "terms K", std::move(yLabel), {0, 8, 16, 24, 32}, true, kColumns, {}};
}

// What was measured of up to 32 terms.
std::vector<glm::dvec2> pointsOf(const MaterialStudy& study, size_t approach, int size, Measure measure,
                                 size_t light) {
    std::vector<glm::dvec2> points;
    for (int terms = 1; terms <= kMaxTerms; terms++)
        if (const auto error = study.error(approach, size, terms, measure, light))
            points.emplace_back(terms, *error);
    return points;
}

void appendRows(std::string& csv, const MaterialStudy& study, const Curve& curve, const char* measure,
                const std::string& light, const std::vector<float>& values) {
    const Approach& approach = approaches()[curve.approach];
    const bool isWhole = approach.method == Factorization::NonNegative;
    for (size_t k = isWhole ? values.size() - 1 : 0; k < values.size(); k++)
        csv += fmt::format("\"{}\",\"{}\",{},{},{},{},\"{}\",{:.6g}\n", study.name, approach.name, curve.size,
                           curve.factored, k + 1, measure, light, values[k]);
}

} // namespace

std::string csvOf(const std::vector<MaterialStudy>& studies, const StudyOptions& options) {
    std::string csv = "material,approach,size,factored_terms,terms,measure,environment,error\n";
    for (const MaterialStudy& study : studies)
        for (const Curve& curve : study.curves) {
            appendRows(csv, study, curve, "rms", "", curve.rms);
            for (size_t light = 0; light < options.lights.size(); light++) {
                appendRows(csv, study, curve, "pixels", options.lightNames[light], curve.pixels[light]);
                appendRows(csv, study, curve, "uniform", options.lightNames[light], curve.uniform[light]);
            }
        }
    return csv;
}

std::string rmsPlot(const std::vector<MaterialStudy>& studies, const StudyOptions& options) {
    LinePlot plot = plotOf("RMS of f cos θi cos θo, relative", "relative RMS");
    for (const MaterialStudy& study : studies) {
        PlotPanel& panel = plot.panels.emplace_back(study.name);
        for (const size_t approach : {kPaper, kDefault})
            for (size_t s = 0; s < options.sizes.size(); s++)
                panel.curves.push_back(
                    {fmt::format("{}, S = {}", approach == kPaper ? "paper" : "default", options.sizes[s]), s,
                     approach == kPaper, pointsOf(study, approach, options.sizes[s], Measure::Rms, 0)});
    }
    return drawLinePlot(plot);
}

std::string radiancePlot(const std::vector<MaterialStudy>& studies, const StudyOptions& options,
                         size_t light) {
    LinePlot plot = plotOf(fmt::format("Error of reflected radiance under {}, S = {}",
                                       options.lightNames[light], options.mainSize()),
                           "relative RMS of radiance");
    for (const MaterialStudy& study : studies) {
        PlotPanel& panel = plot.panels.emplace_back(study.name);
        for (size_t a = 0; a < approaches().size(); a++) {
            const Approach& approach = approaches()[a];
            const bool isAside = approach.method == Factorization::Paper || a == kCentres;
            panel.curves.push_back({approach.name, approach.colour, isAside,
                                    pointsOf(study, a, options.mainSize(), Measure::Pixels, light)});
        }
    }
    return drawLinePlot(plot);
}

} // namespace relume
