// How transport is kept: options that several subcommands share.
#pragma once

#include "engine/transport/asset.h"
#include "precompute/layout/layout_options.h"

#include <CLI/CLI.hpp>
#include <optional>

namespace relume {

// --layout, --budget, --error
struct LayoutArguments {
    // Without `hasDefaults` nothing has a default but what resolve() is told.
    void add(CLI::App& command, bool hasDefaults);
    bool areGiven() const { return mLayout || mBudget || mError; }
    // What was given, else of these. Throws UsageError.
    LayoutOptions resolve(const LayoutOptions& otherwise = {}) const;

  private:
    std::optional<std::string> mLayout;
    std::optional<double> mBudget, mError;
};

enum class LayoutOrigin { Baked, Converted };

// Says where what was asked for was missed, and why. `bytesPerVertex`: that it takes.
void warnOfMisses(const LayoutRecord& layout, double bytesPerVertex, LayoutOrigin origin);

} // namespace relume
