// The format of --help: options with their argument names, defaults beside the text, wrapped lines.
#pragma once

#include <CLI/CLI.hpp>

namespace relume {

class HelpFormatter : public CLI::Formatter {
  public:
    std::string make_option(const CLI::Option* option, bool isPositional) const override;
    std::string make_subcommand(const CLI::App* command) const override;
};

} // namespace relume
