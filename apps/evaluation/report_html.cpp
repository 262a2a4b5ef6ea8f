#include "apps/evaluation/report_html.h"

#include "apps/evaluation/base64.h"
#include "apps/plot/markup.h"
#include "engine/base/check.h"
#include "engine/base/file.h"

#include <fmt/format.h>
#include <string_view>

namespace relume {

namespace {

constexpr std::string_view kStyle = R"(
body { font: 15px/1.5 Georgia, 'DejaVu Serif', serif; color: #1a1a1a; background: #fff; max-width: 76rem;
  margin: 2rem auto; padding: 0 1.5rem; }
h1, h2, th, figcaption, .facts { font-family: Helvetica, Arial, 'DejaVu Sans', sans-serif; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-bottom: 1px solid #bbb; }
p, li { max-width: 48rem; }
table { border-collapse: collapse; margin: 1rem 0 .3rem; font-size: 13px; }
caption { text-align: left; font-weight: bold; padding-bottom: .3rem; }
th, td { padding: .2rem .7rem; border-bottom: 1px solid #ddd; text-align: right; vertical-align: baseline;
  font-variant-numeric: tabular-nums; }
th { border-bottom: 1px solid #777; vertical-align: bottom; } th:first-child, td:first-child { text-align: left; }
.facts th { font-weight: normal; color: #555; text-align: left; border: 0; } .facts td { text-align: left; border: 0; }
.note { font-size: 13px; color: #444; margin-top: .2rem; }
.figure { margin: 1rem 0; } .pictures { display: grid; gap: .8rem; align-items: start; }
figure { margin: 0; } figure img { width: 100%; height: auto; display: block; }
figcaption { font-size: 12.5px; color: #333; padding-top: .2rem; } figcaption b { color: #000; }
@media print { body { margin: 0; font-size: 11px; max-width: none; } figure, tr { break-inside: avoid; }
  h2 { break-after: avoid; } }
)";

std::string dataOf(const char* type, std::span<const std::byte> bytes) {
    return fmt::format("data:image/{};base64,{}", type, base64(bytes));
}

std::string paragraph(std::string_view text, std::string_view style = "") {
    if (text.empty()) return "";
    const std::string name = style.empty() ? "" : fmt::format(" class=\"{}\"", style);
    return fmt::format("<p{}>{}</p>\n", name, escapedMarkup(text));
}

// Nothing where there are no lines.
std::string list(const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return "";
    std::string html = fmt::format("<h2>{}</h2>\n<ul>\n", title);
    for (const std::string& line : lines) html += fmt::format("<li>{}</li>\n", escapedMarkup(line));
    return html + "</ul>\n";
}

// Writes items into a page.
struct ItemWriter {
    const std::filesystem::path& folder;
    std::string& html;

    void operator()(const Paragraph& item) const { html += paragraph(item.text); }

    void operator()(const ReportTable& table) const {
        html += fmt::format("<table>\n<caption>{}</caption>\n<thead><tr>", escapedMarkup(table.title));
        for (const std::string& column : table.columns)
            html += fmt::format("<th>{}</th>", escapedMarkup(column));
        html += "</tr></thead>\n<tbody>\n";
        for (const auto& row : table.rows) {
            RELUME_CHECK_EQ(row.size(), table.columns.size());
            html += "<tr>";
            for (const std::string& cell : row) html += fmt::format("<td>{}</td>", escapedMarkup(cell));
            html += "</tr>\n";
        }
        html += "</tbody></table>\n" + paragraph(table.note, "note");
    }

    void operator()(const ReportFigure& figure) const {
        html += fmt::format("<div class=\"figure\">\n<p><b>{}</b></p>\n<div class=\"pictures\" "
                            "style=\"grid-template-columns: repeat({}, 1fr)\">\n",
                            escapedMarkup(figure.title), figure.columns);
        for (const Picture& picture : figure.pictures)
            html += fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption><b>{}</b> {}</figcaption>"
                                "</figure>\n",
                                dataOf("png", readFile(folder / picture.file)),
                                escapedMarkup(picture.title + " " + picture.caption),
                                escapedMarkup(picture.title), escapedMarkup(picture.caption));
        html += "</div>\n" + paragraph(figure.note, "note") + "</div>\n";
    }

    void operator()(const ReportPlot& plot) const {
        html += fmt::format("<div class=\"figure\">\n<p><b>{0}</b></p>\n<figure><img src=\"{1}\" "
                            "alt=\"{0}\"></figure>\n</div>\n",
                            escapedMarkup(plot.title), dataOf("svg+xml", std::as_bytes(std::span(plot.svg))));
    }
};

} // namespace

std::string htmlOf(const Report& report, const std::filesystem::path& folder) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n"
        "<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n",
        escapedMarkup(report.title), kStyle, escapedMarkup(report.title));
    html += list("What was found", report.findings) + "<table class=\"facts\">\n";
    for (const auto& [name, value] : report.facts)
        html += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", escapedMarkup(name), escapedMarkup(value));
    html += "</table>\n" + list("What is missing", report.skipped);
    for (const ReportSection& section : report.sections) {
        html += fmt::format("<h2>{}</h2>\n", escapedMarkup(section.title));
        for (const ReportItem& item : section.items) std::visit(ItemWriter{folder, html}, item);
    }
    html += "</body>\n</html>\n";
    return html;
}

} // namespace relume
