// --threshold, --coefficients, --area-weighted: which coefficients of the light are kept.
#pragma once

#include "engine/light/usual_light.h"

#include <CLI/CLI.hpp>

namespace relume {

class SelectionArguments {
  public:
    void add(CLI::App& command);
    LightSelection selection() const; // kUsualLight, unless something else is asked for

  private:
    std::optional<int> mThreshold, mCount;
    bool mAreaWeighted = false;
};

} // namespace relume
