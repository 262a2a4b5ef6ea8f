#include "apps/layout_study/report.h"

#include "apps/plot/line_plot.h"

#include <algorithm>
#include <fmt/format.h>

namespace relume {

namespace {

constexpr TransportLayout kLayouts[] = {TransportLayout::Rows, TransportLayout::Clusters,
                                        TransportLayout::Bases};

using Errors = std::vector<double> Variant::*;

std::string errorPlot(const std::vector<BakeStudy>& studies, const StudyOptions& options, Errors errors,
                      const char* label) {
    LinePlot plot{.title = label,
                  .xLabel = "bytes of transport a vertex, in memory",
                  .yLabel = "relative error",
                  .xTicks = {50, 200, 800, 3200, 12800},
                  .logarithmic = true,
                  .columns = int(options.lights.size()),
                  .panels = {},
                  .logarithmicX = true};
    const double least = plot.xTicks.front(), most = plot.xTicks.back();
    for (const BakeStudy& study : studies)
        for (size_t light = 0; light < options.lights.size(); light++) {
            PlotPanel& panel =
                plot.panels.emplace_back(fmt::format("{}, {}", study.name, options.lightNames[light]));
            for (const TransportLayout layout : kLayouts) {
                PlotCurve curve{layoutName(layout), size_t(layout), false, {}};
                for (const Variant& variant : study.variants)
                    if (variant.layout == layout && variant.bytes >= least && variant.bytes <= most)
                        curve.points.emplace_back(variant.bytes, (variant.*errors)[light]);
                std::ranges::sort(curve.points, {}, [](glm::dvec2 point) { return point.x; });
                panel.curves.push_back(std::move(curve));
            }
        }
    return drawLinePlot(plot);
}

std::string tableRow(const Variant& variant, const std::string& name) {
    std::string row = fmt::format("| {} | {:.0f} | {:.0f} | {:.3f} |", name, variant.bytes, variant.onDisk,
                                  variant.transportError);
    for (const double error : variant.relitErrors) row += fmt::format(" {:.3f} |", error);
    for (const double error : variant.imageErrors) row += fmt::format(" {:.3f} |", error);
    row += "\n";
    return row;
}

} // namespace

std::string csvOf(const std::vector<BakeStudy>& studies, const StudyOptions& options) {
    std::string csv =
        "bake,vertices,terms,layout,bytes,on_disk,transport_error,environment,relit_error,image_error\n";
    for (const BakeStudy& study : studies) {
        const auto append = [&](const Variant& variant, const std::string& layout) {
            for (size_t light = 0; light < options.lights.size(); light++)
                csv += fmt::format("\"{}\",{},{},{},{:.6g},{:.6g},{:.6g},\"{}\",{:.6g},{:.6g}\n", study.name,
                                   study.vertices, study.terms, layout, variant.bytes, variant.onDisk,
                                   variant.transportError, options.lightNames[light],
                                   variant.relitErrors[light], variant.imageErrors[light]);
        };
        append(study.source, "source");
        for (const Variant& variant : study.variants) append(variant, variant.name);
    }
    return csv;
}

std::string relitPlot(const std::vector<BakeStudy>& studies, const StudyOptions& options) {
    return errorPlot(studies, options, &Variant::relitErrors, "Error of relit tuples");
}

std::string imagePlot(const std::vector<BakeStudy>& studies, const StudyOptions& options) {
    return errorPlot(studies, options, &Variant::imageErrors, "Error of images against ray tracing");
}

std::string summaryOf(const std::vector<BakeStudy>& studies, const StudyOptions& options) {
    std::string summary;
    for (const BakeStudy& study : studies) {
        summary += fmt::format("{}: {} vertices, K = {}\n\n| | bytes | on disk | transport |", study.name,
                               study.vertices, study.terms);
        for (const char* what : {"relit", "image"})
            for (const std::string& light : options.lightNames)
                summary += fmt::format(" {}: {} |", what, light);
        summary += "\n|---|---|---|---|";
        for (size_t i = 0; i < 2 * options.lights.size(); i++) summary += "---|";
        summary += "\n";
        summary += tableRow(study.source, "the bake");
        for (const Variant& variant : study.variants) summary += tableRow(variant, variant.name);
        summary += "\n";
    }
    return summary;
}

} // namespace relume
