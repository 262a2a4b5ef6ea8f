#include "apps/relume/layout_arguments.h"

#include "apps/relume/options.h"
#include "engine/base/error.h"

#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace relume {

void LayoutArguments::add(CLI::App& command, bool hasDefaults) {
    std::vector<std::string> names;
    for (const LayoutFacts& facts : kLayoutFacts) names.push_back(facts.name);
    const LayoutOptions defaults;
    command
        .add_option(
            "--layout", mLayout,
            "How transport is kept. bases: 256 vertices share basis vectors, smallest, fastest on CPUs; "
            "rows: each vertex its own coefficients")
        ->check(CLI::IsMember(names))
        ->type_name("LAYOUT")
        ->default_str(hasDefaults ? layoutName(defaults.layout) : "the bake's own");
    CLI::Option* budget =
        command
            .add_option("--budget", mBudget,
                        "Bytes of transport per vertex, in memory, that the least error is sought within; a "
                        "bake, which goes by a sample, meets it about")
            ->check(between(1, float(kMostLayoutBytes)))
            ->type_name("BYTES");
    command
        .add_option(
            "--error", mError,
            "Error of transport that the fewest bytes are sought for, as light weighs it: 0.05 is 5 %; a "
            "bake meets it about")
        ->check(between(float(kLeastLayoutError), 1))
        ->type_name("ERROR")
        ->default_str(
            hasDefaults ? fmt::format("{}; {} where all is diffuse", kDefaultLayoutError, kDiffuseLayoutError)
                        : "the bake's own")
        ->excludes(budget);
}

LayoutOptions LayoutArguments::resolve(const LayoutOptions& otherwise) const {
    LayoutOptions options = otherwise;
    if (mLayout)
        options.layout = *layoutFromName(*mLayout);
    else if ((mBudget || mError) && !isCompressed(options.layout))
        options.layout = TransportLayout::Bases; // rows have neither
    if (!isCompressed(options.layout)) {
        if (mBudget || mError)
            throw UsageError("--layout rows: --budget and --error are for bases; rows are "
                             "shortened by --coefficients");
        return {.layout = options.layout};
    }
    if (mBudget) options.bytesPerVertex = mBudget;
    if (mError) {
        options.error = *mError;
        options.bytesPerVertex.reset();
    }
    return options;
}

void warnOfMisses(const LayoutRecord& layout, double bytesPerVertex, LayoutOrigin origin) {
    constexpr double kHardlyMore = 1.05;
    const bool isBaked = origin == LayoutOrigin::Baked; // then a miss is mostly due to the sample
    if (layout.wantedBytes && bytesPerVertex > kHardlyMore * *layout.wantedBytes) {
        if (isBaked)
            spdlog::warn(
                "{} bytes a vertex were asked for, and it has {:.0f}: the sample that a bake goes by "
                "missed, or this layout cannot do with less; `relume convert` of a bake in rows meets a "
                "budget exactly if it can be met",
                *layout.wantedBytes, bytesPerVertex);
        else
            spdlog::warn("a budget of {} bytes a vertex is less than this layout can do with; it has {:.0f}",
                         *layout.wantedBytes, bytesPerVertex);
    }
    if (layout.wantedError && layout.error > kHardlyMore * *layout.wantedError) {
        if (isBaked)
            spdlog::warn(
                "an error of {:.2f} % was asked for, and it is {:.2f} %: the sample that a bake goes by "
                "missed, or it is beyond this layout's precision; `relume convert` of a bake in rows "
                "meets an error exactly if it can be met",
                100 * *layout.wantedError, 100 * layout.error);
        else
            spdlog::warn(
                "an error of {:.2f} % is beyond this layout's precision; rows of many coefficients keep more",
                100 * *layout.wantedError);
    }
    if (layout.error > 0.5)
        spdlog::warn("more than half of what tells vertices apart is lost; ask for more bytes");
}

} // namespace relume
