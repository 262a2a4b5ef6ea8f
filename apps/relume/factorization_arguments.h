// How a BRDF is factored: options that several subcommands share.
#pragma once

#include "engine/math/disk_map.h"
#include "precompute/brdf/factorization.h"

#include <CLI/CLI.hpp>

namespace relume {

// --terms, --factorization, --map
struct FactorizationArguments {
    FactorizationOptions options; // `terms` is the most that are allowed where an error is wanted
    DiskMapping mapping = DiskMapping::EqualArea;

    void add(CLI::App& command, int defaultTerms);
    // Fills the above from what was given. Throws UsageError.
    void resolve();

  private:
    std::string mTerms, mMethod, mMapping;
};

} // namespace relume
