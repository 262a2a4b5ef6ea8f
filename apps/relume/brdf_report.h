// The measurements of a factored BRDF that `relume brdf` prints.
#pragma once

#include "engine/light/light_cube.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/factorization.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relume {

struct NamedLight {
    std::string name;
    LightCube cube;
};

// The results of reportOn().
struct BrdfReport {
    nlohmann::json material;
    Factorization method = Factorization::Environment;
    int directions = 0; // n
    double tabulationSeconds = 0, factorizationSeconds = 0;
    FactoredBrdf factored;
    // Errors after each term, with their name in the JSON.
    struct Curve {
        std::string name;
        std::vector<float> values;
    };
    Curve frobenius, absolute, relative, expected;
    std::vector<Curve> radiance; // per light
};

// Tabulates and factors a BRDF, and measures the errors.
BrdfReport reportOn(const Brdf& brdf, int size, DiskMapping mapping, const FactorizationOptions& options,
                    const std::vector<NamedLight>& lights);

nlohmann::ordered_json describeReport(const BrdfReport& report);
// Returns a table of some numbers of terms, for people.
std::string tableOf(const BrdfReport& report);

} // namespace relume
