// --threshold, --coefficients, --area-weighted: which coefficients of the light are kept.
#pragma once

#include "engine/light/light_selection.h"

#include <CLI/CLI.hpp>

namespace relume {

struct SelectionArguments {
    LightSelection selection;

    void add(CLI::App& command);
};

} // namespace relume
