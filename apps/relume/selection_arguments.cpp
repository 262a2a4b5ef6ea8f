#include "apps/relume/selection_arguments.h"

#include "engine/light/light_vector.h"

namespace relume {

void SelectionArguments::add(CLI::App& command) {
    CLI::Option* threshold = command
                                 .add_option("--threshold", selection.threshold,
                                             "Drop light coefficients below this, where the largest is 32767")
                                 ->check(CLI::Range(0, kLightMaximum))
                                 ->capture_default_str();
    command
        .add_option("--coefficients", selection.count,
                    "Keep so many light coefficients, the largest, instead")
        ->type_name("COUNT")
        ->check(CLI::Range(1, int(kMaximumLightEntries)))
        ->excludes(threshold);
    command.add_flag("--area-weighted", selection.areaWeighted,
                     "Weigh light coefficients by the area of their functions when selecting");
}

} // namespace relume
