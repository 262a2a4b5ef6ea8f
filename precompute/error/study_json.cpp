#include "precompute/error/study_json.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace relume {

static nlohmann::ordered_json describeSources(const ErrorBudget& budget) {
    nlohmann::ordered_json sources;
    for (size_t i = 0; i < kErrorSources; i++)
        sources[std::string(errorSourceName(ErrorSource(i)))] = {{"title", errorSourceTitle(ErrorSource(i))},
                                                                 {"rms", budget.sources[i].rms},
                                                                 {"share", budget.sources[i].share}};
    return sources;
}

// A part's errors are relative to the truth at its own points.
static nlohmann::ordered_json describeParts(const ErrorStudy& study, const ViewPoints& points,
                                            const Asset& asset) {
    nlohmann::ordered_json parts = nlohmann::ordered_json::array();
    for (size_t part = 0; part < asset.parts.size(); part++) {
        std::vector<StageRadiance> own;
        for (size_t i = 0; i < points.hits.size(); i++)
            if (points.hits[i].mesh == part) own.push_back(study.stages[i]);
        if (own.empty()) continue;
        parts.push_back({{"name", asset.parts[part].name},
                         {"points", own.size()},
                         {"sources", describeSources(errorBudget(own))}});
    }
    return parts;
}

nlohmann::ordered_json describe(const ErrorStudy& study, const ViewPoints& points, const Asset& asset) {
    nlohmann::ordered_json described = {{"points", study.stages.size()},
                                        {"sources", describeSources(study.budget)},
                                        {"parts", describeParts(study, points, asset)},
                                        {"total", study.budget.total},
                                        {"total_standard_error", study.budget.uncertainty},
                                        {"root_sum_of_squares", study.budget.rootSumSquares},
                                        {"measured", study.measured},
                                        {"reference_noise", study.noise},
                                        {"reference_passes", study.passes},
                                        {"unexplained_truth", study.truthAside}};
    if (study.lowOrder) {
        described["spherical_harmonics"] = study.lowOrder->error;
        described["spherical_harmonics_of_terms"] = study.lowOrder->termsError;
    }
    return described;
}

std::string commandLineOf(const BakeOptions& options) {
    std::string text = fmt::format("--terms {} --factorization {}", options.factorization.terms.value(),
                                   factorizationName(options.factorization.method));
    if (options.layout.layout == TransportLayout::Rows)
        text += fmt::format(" --layout rows --coefficients {}", options.coefficients);
    else
        text += fmt::format(" --error {:.3g}", *options.layout.error);
    text +=
        options.refinement ? fmt::format(" --refine {:.3g}", options.refinement->wanted) : " --refine off";
    return text;
}

namespace {

nlohmann::ordered_json describe(const std::optional<AdvisedBake>& bake, uint64_t vertices) {
    if (!bake) return nullptr;
    return {{"options", commandLineOf(bake->options)},
            {"terms", bake->options.factorization.terms.value()},
            {"error", bake->error},
            {"bytes", uint64_t(bake->bytes)},
            {"bytes_per_vertex", uint64_t(bake->bytes / double(vertices))},
            {"seconds", bake->seconds ? nlohmann::ordered_json(*bake->seconds) : nullptr}};
}

nlohmann::ordered_json describe(const MeshAdvice& advice) {
    return {{"vertices", advice.vertices},
            {"bases", describe(advice.bases, advice.vertices)},
            {"rows", describe(advice.rows, advice.vertices)},
            {"least_errors", advice.leastErrors}};
}

} // namespace

nlohmann::ordered_json describe(const Advice& advice, double asked) {
    nlohmann::ordered_json described = {{"asked", asked}, {"plain", describe(advice.plain)}};
    if (advice.refined) described["refined"] = describe(*advice.refined);
    const AdvisedBake* best = advice.best();
    described["best"] = best ? nlohmann::ordered_json(commandLineOf(best->options)) : nullptr;
    return described;
}

} // namespace relume
