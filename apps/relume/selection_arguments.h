// --threshold, --coefficients, --area-weighted and --no-area-weighted: the selection of light entries.
#pragma once

#include "engine/light/light_selection.h"

#include <CLI/CLI.hpp>

namespace relume {

class SelectionArguments {
  public:
    void add(CLI::App& command);
    // Returns the selection that was given, or `otherwise` if none was.
    LightSelection selection(const LightSelection& otherwise = {}) const;

  private:
    std::optional<int> mThreshold;
    std::optional<int> mCount;
    std::optional<bool> mAreaWeighted;
};

} // namespace relume
