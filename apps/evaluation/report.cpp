#include "apps/evaluation/report.h"

namespace relume {

namespace {

std::string cellOf(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"') quoted += '"';
        quoted += letter;
    }
    return quoted + '"';
}

void appendLine(std::string& csv, const std::vector<std::string>& cells) {
    for (size_t i = 0; i < cells.size(); i++) {
        if (i > 0) csv += ',';
        csv += cellOf(cells[i]);
    }
    csv += "\r\n";
}

} // namespace

std::string csvOf(const ReportTable& table) {
    std::string csv;
    appendLine(csv, table.columns);
    for (const auto& row : table.rows) appendLine(csv, row);
    return csv;
}

} // namespace relume
