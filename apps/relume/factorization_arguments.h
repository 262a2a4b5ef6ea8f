// The options that say how a BRDF is factored, shared by several subcommands.
#pragma once

#include "engine/math/disk_map.h"
#include "precompute/brdf/factorization.h"

#include <CLI/CLI.hpp>
#include <optional>

namespace relume {

// --terms, --factorization, --map
struct FactorizationArguments {
    FactorizationOptions options; // if an error is wanted, `terms` is the upper bound
    DiskMapping mapping = DiskMapping::EqualArea;

    // Help shows `defaults`; without them, options not given keep what the bake has.
    void add(CLI::App& command, const std::optional<FactorizationOptions>& defaults);
    // Fills `options` and `mapping` from the given options, otherwise from the arguments. A method without
    // --map implies its own mapping; --terms auto:E implies a method whose terms are nested, if none is
    // given. Throws UsageError.
    void resolve(const FactorizationOptions& otherwise = {}, DiskMapping map = DiskMapping::EqualArea);

  private:
    std::optional<std::string> mTerms, mMethod, mMapping;
};

} // namespace relume
