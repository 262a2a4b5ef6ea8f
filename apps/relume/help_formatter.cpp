#include "apps/relume/help_formatter.h"

#include <algorithm>
#include <sstream>

namespace relume {

namespace {

constexpr size_t kColumns = 100, kTextColumn = 30;

// Returns what an option takes: the words of a set, or its type's name without the range, which error
// messages state.
std::string valueOf(const CLI::Option& option) {
    if (option.get_type_size() == 0) return ""; // a flag
    std::string type = option.get_type_name();
    if (const size_t set = type.find(":{"); set != std::string::npos && type.ends_with('}')) {
        type = type.substr(set + 2, type.size() - set - 3);
        std::ranges::replace(type, ',', '|');
        return " " + type;
    }
    type = type.substr(0, type.find(':'));
    if (type == "INT" || type == "UINT") type = "N";
    if (type == "FLOAT") type = "X";
    if (option.get_positional() && type == "TEXT") return "";
    return (type.empty() ? "" : " " + type) +
           (option.get_expected_max() == CLI::detail::expected_max_vector_size ? " ..." : "");
}

// Returns the names of an option, without the values that CLI11 writes in braces after those of flags.
std::string nameOf(const CLI::Option& option, bool isPositional) {
    std::string name = option.get_name(isPositional, !isPositional);
    for (size_t open; (open = name.find('{')) != std::string::npos;)
        name.erase(open, name.find('}', open) - open + 1);
    for (size_t comma = 0; (comma = name.find(',', comma)) != std::string::npos; comma += 2)
        name.replace(comma, 1, ", ");
    return name;
}

// Returns the description, with whether the option is required and its default.
std::string textOf(const CLI::Option& option) {
    std::string text = option.get_description();
    const std::string standard = option.get_default_str();
    if (option.get_required()) text += " (required)";
    if (!standard.empty() && option.get_type_size() != 0) text += " (default: " + standard + ")";
    return text;
}

// Appends words to `out`, with every line starting at kTextColumn; `at` is the current column.
void wrap(const std::string& text, size_t at, std::ostringstream& out) {
    std::istringstream words(text);
    const auto beginText = [&] {
        if (at > kTextColumn - 2) out << '\n', at = 0;
        out << std::string(kTextColumn - at, ' ');
        at = kTextColumn;
    };
    beginText();
    for (std::string word; words >> word;) {
        const bool isFirst = at == kTextColumn;
        if (!isFirst && at + 1 + word.size() > kColumns) beginText();
        if (at > kTextColumn) out << ' ', at++;
        out << word;
        at += word.size();
    }
    out << '\n';
}

} // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool isPositional) const {
    std::ostringstream out;
    const std::string head = "  " + nameOf(*option, isPositional) + valueOf(*option);
    out << head;
    wrap(textOf(*option), head.size(), out);
    return out.str();
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
    std::ostringstream out;
    const std::string head = "  " + command->get_name();
    out << head;
    wrap(command->get_description(), head.size(), out);
    return out.str();
}

} // namespace relume
