#include "precompute/error/study_json.h"

#include <nlohmann/json.hpp>

namespace relume {

nlohmann::ordered_json describe(const ErrorStudy& study) {
    nlohmann::ordered_json sources;
    for (size_t i = 0; i < kErrorSources; i++)
        sources[std::string(errorSourceName(ErrorSource(i)))] = {{"rms", study.budget.sources[i].rms},
                                                                 {"share", study.budget.sources[i].share}};
    nlohmann::ordered_json json = {{"points", study.stages.size()},
                                   {"sources", sources},
                                   {"total", study.budget.total},
                                   {"total_standard_error", study.budget.uncertainty},
                                   {"root_sum_of_squares", study.budget.rootSumSquares},
                                   {"measured", study.measured},
                                   {"reference_noise", study.noise},
                                   {"reference_passes", study.passes},
                                   {"unexplained_truth", study.truthAside}};
    if (study.lowOrder) {
        json["spherical_harmonics"] = study.lowOrder->error;
        json["spherical_harmonics_of_terms"] = study.lowOrder->termsError;
    }
    return json;
}

} // namespace relume
