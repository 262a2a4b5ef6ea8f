// How a BRDF is factored: options that several subcommands share.
#pragma once

#include "engine/math/disk_map.h"
#include "precompute/brdf/factorization.h"

#include <CLI/CLI.hpp>
#include <optional>

namespace relume {

// --terms, --factorization, --map
struct FactorizationArguments {
    FactorizationOptions options; // `terms` is the most that are allowed where an error is wanted
    DiskMapping mapping = DiskMapping::EqualArea;

    // Without `defaultTerms` nothing has a default but what resolve() is told.
    void add(CLI::App& command, std::optional<int> defaultTerms);
    // Fills the above from what was given, else from these; a method without --map brings its own map. Throws
    // UsageError.
    void resolve(const FactorizationOptions& otherwise = {}, DiskMapping map = DiskMapping::EqualArea);

  private:
    std::string mTerms, mMethod, mMapping;
};

} // namespace relume
