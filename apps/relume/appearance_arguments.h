// The options of `render` and `reference` that bind materials to parts.
#pragma once

#include "engine/render/appearance.h"

#include <CLI/CLI.hpp>

namespace relume {

// --material NAME[=WEIGHT], repeatable
struct AppearanceArguments {
    void add(CLI::App& command);
    // Returns the default appearance with the named materials bound. Throws UsageError.
    Appearance appearance(const Asset& asset) const;

  private:
    std::vector<std::string> mMaterials;
};

} // namespace relume
