// --threshold, --coefficients, --area-weighted and --no-area-weighted: which coefficients of the light are
// kept.
#pragma once

#include "engine/light/light_selection.h"

#include <CLI/CLI.hpp>

namespace relume {

class SelectionArguments {
  public:
    void add(CLI::App& command);
    LightSelection selection() const;

  private:
    std::optional<int> mThreshold;
    int mCount = kDefaultLightCount;
    std::optional<bool> mAreaWeighted;
};

} // namespace relume
