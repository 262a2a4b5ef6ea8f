#include "apps/relume/selection_arguments.h"

#include "engine/light/light_vector.h"

#include <fmt/core.h>

namespace relume {

void SelectionArguments::add(CLI::App& command) {
    CLI::Option* threshold =
        command
            .add_option("--threshold", mThreshold,
                        "Drop light coefficients below this, where the largest is 32767; the paper's is 1024")
            ->type_name("VALUE")
            ->check(CLI::Range(0, kLightMaximum));
    command
        .add_option("--coefficients", mCount,
                    "Keep so many light coefficients, those that weigh most, instead")
        ->type_name("COUNT")
        ->check(CLI::Range(1, int(kMaximumLightEntries)))
        ->default_str(fmt::format("{}", kDefaultLightCount))
        ->excludes(threshold);
    command.add_flag_function(
        "--area-weighted,!--no-area-weighted", [this](int64_t count) { mAreaWeighted = count > 0; },
        "Weigh light coefficients by the area of their functions when selecting (default: unless by "
        "--threshold)");
}

LightSelection SelectionArguments::selection(const LightSelection& otherwise) const {
    LightSelection selection = otherwise;
    if (mThreshold || mCount) selection = {mThreshold, mCount.value_or(kDefaultLightCount)};
    if (mAreaWeighted) selection.areaWeighted = mAreaWeighted;
    return selection;
}

} // namespace relume
