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

    // Help tells of `defaults`; without, what the bake has is kept.
    void add(CLI::App& command, const std::optional<FactorizationOptions>& defaults);
    // Fills the above from what was given, else from these; a method without --map brings its own map, and
    // terms that are to reach an error a method that can say how many do. Throws UsageError.
    void resolve(const FactorizationOptions& otherwise = {}, DiskMapping map = DiskMapping::EqualArea);

  private:
    std::optional<std::string> mTerms, mMethod, mMapping;
};

} // namespace relume
