// What `relume brdf` measures of a factored BRDF, and how it says so.
#pragma once

#include "engine/light/light_cube.h"
#include "precompute/brdf/factorization.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relume {

struct NamedLight {
    std::string name;
    LightCube cube;
};

struct BrdfReport {
    nlohmann::json material;
    Factorization method = Factorization::Environment;
    int directions = 0; // n
    double tabulationSeconds = 0, factorizationSeconds = 0;
    FactoredBrdf factored;
    // After each term. Each is a name, as in the JSON, and its curve.
    struct Curve {
        std::string name;
        std::vector<float> values;
    };
    Curve frobenius, absolute, relative, expected;
    std::vector<Curve> radiance; // per light
};

// Tabulates, factors, measures.
BrdfReport reportOn(const Brdf& brdf, int size, DiskMapping mapping, const FactorizationOptions& options,
                    const std::vector<NamedLight>& lights);

nlohmann::ordered_json describeReport(const BrdfReport& report);
// A table of some term counts, for people.
std::string tableOf(const BrdfReport& report);

} // namespace relume
