// The options that say how transport is stored, shared by several subcommands.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/layout/layout_options.h"

#include <CLI/CLI.hpp>
#include <optional>

namespace relume {

// --layout, --budget, --error
struct LayoutArguments {
    // If not `hasDefaults`, help says that options not given keep those of the bake.
    void add(CLI::App& command, bool hasDefaults);
    bool areGiven() const { return mLayout || mBudget || mError; }
    // Returns the given options, and `otherwise` for the others. Throws UsageError.
    LayoutOptions resolve(const LayoutOptions& otherwise = {}) const;

  private:
    std::optional<std::string> mLayout;
    std::optional<double> mBudget, mError;
};

enum class LayoutOrigin { Baked, Converted };

// Warns if a wanted size or error was missed, and says why. `bytesPerVertex` is the actual size.
void warnOfMisses(const LayoutRecord& layout, double bytesPerVertex, LayoutOrigin origin);

} // namespace relume
