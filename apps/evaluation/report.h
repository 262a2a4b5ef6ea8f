// What a report says, section by section: written as one HTML file by report_html.h, its tables as CSV and
// its plots as SVG too.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace relume {

struct Paragraph {
    std::string text;
};

struct ReportTable {
    std::string file; // of its CSV, without folder and extension
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows; // as many cells each as there are columns
    std::string note;                           // below it; may be empty
};

struct Picture {
    std::filesystem::path file; // .png, from the report's folder
    std::string title, caption; // one line each; either may be empty
};

// Pictures side by side, `columns` of them in a line.
struct ReportFigure {
    std::string title;
    int columns = 1;
    std::vector<Picture> pictures;
    std::string note;
};

// A drawing of the report's own.
struct ReportPlot {
    std::string file; // without folder and extension
    std::string title;
    std::string svg;
};

using ReportItem = std::variant<Paragraph, ReportTable, ReportFigure, ReportPlot>;

struct ReportSection {
    std::string title;
    std::vector<ReportItem> items = {};
    std::vector<std::string> findings = {}; // a sentence or two each

    void add(ReportItem item) { items.push_back(std::move(item)); }
    void say(std::string text) { items.emplace_back(Paragraph{std::move(text)}); }
};

struct Report {
    std::string title;
    std::vector<std::pair<std::string, std::string>> facts; // device, date, …: name and value
    std::vector<std::string> skipped;                       // a line each
    std::vector<ReportSection> sections;
    std::vector<std::string> findings = {}; // of all sections: before all else
};

// RFC 4180: cells with commas, quotes or line breaks are quoted.
std::string csvOf(const ReportTable& table);

} // namespace relume
