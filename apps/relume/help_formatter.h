// How --help looks: options with the words that they take, their defaults beside the text, wrapped.
#pragma once

#include <CLI/CLI.hpp>

namespace relume {

class HelpFormatter : public CLI::Formatter {
  public:
    std::string make_option(const CLI::Option* option, bool isPositional) const override;
    std::string make_subcommand(const CLI::App* command) const override;
};

} // namespace relume
