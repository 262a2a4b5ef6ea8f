#include "apps/relume/brdf_report.h"

#include "engine/base/stopwatch.h"
#include "precompute/brdf/factorization_error.h"
#include "precompute/brdf/tabulation.h"

#include <algorithm>
#include <filesystem>
#include <fmt/core.h>

namespace relume {

namespace {

std::vector<float> eigenvaluesOf(const FactoredBrdf& factored, size_t channel) {
    std::vector<float> values;
    for (const std::array<float, 3>& term : factored.eigenvalues) values.push_back(term[channel]);
    return values;
}

// Returns 1, 2, 4, 8, then every eighth, and the last count.
std::vector<int> someTermCounts(int terms) {
    std::vector<int> counts;
    for (const int count : {1, 2, 4, 8, 16, 24, 32})
        if (count < terms) counts.push_back(count);
    counts.push_back(terms);
    return counts;
}

std::string stemOf(const std::string& file) { return std::filesystem::path(file).stem().string(); }

} // namespace

BrdfReport reportOn(const Brdf& brdf, int size, DiskMapping mapping, const FactorizationOptions& options,
                    const std::vector<NamedLight>& lights) {
    BrdfReport report{.material = brdf.describe(), .method = options.method};
    Stopwatch watch;
    const BrdfTable table = tabulate(brdf, size, mapping, texelValueOf(options.method));
    report.tabulationSeconds = watch.restart();
    report.factored = factorize(table, options);
    report.factorizationSeconds = watch.seconds();
    report.directions = int(table.directions.size());

    report.frobenius = {"frobenius_residual", frobeniusResiduals(table, report.factored)};
    const RmsErrors rms = rmsErrors(brdf, report.factored);
    report.absolute = {"rms_absolute", rms.absolute};
    report.relative = {"rms_relative", rms.relative};
    report.expected = {"expected_radiance_error", expectedErrors(table, report.factored)};
    std::vector<LightCube> cubes;
    for (const NamedLight& light : lights) cubes.push_back(light.cube);
    const LayerOf layer{&report.factored};
    const auto errors = radianceErrors(brdf, std::span(&layer, 1), cubes);
    for (size_t l = 0; l < lights.size(); l++) report.radiance.push_back({lights[l].name, errors[l][0]});
    return report;
}

nlohmann::ordered_json describeReport(const BrdfReport& report) {
    const FactoredBrdf& factored = report.factored;
    nlohmann::ordered_json json = {
        {"material", report.material},
        {"terms", factored.terms},
        {"size", factored.size},
        {"map", diskMappingName(factored.mapping)},
        {"factorization", factorizationName(report.method)},
        {"directions", report.directions},
        {"seconds",
         {{"tabulation", report.tabulationSeconds}, {"factorization", report.factorizationSeconds}}},
        {"eigenvalues",
         {eigenvaluesOf(factored, 0), eigenvaluesOf(factored, 1), eigenvaluesOf(factored, 2)}}};
    for (const BrdfReport::Curve* curve :
         {&report.frobenius, &report.absolute, &report.relative, &report.expected})
        json[curve->name] = curve->values;
    for (const BrdfReport::Curve& curve : report.radiance) json["radiance_error"][curve.name] = curve.values;
    return json;
}

std::string tableOf(const BrdfReport& report) {
    const FactoredBrdf& factored = report.factored;
    std::string table =
        fmt::format("{}\n{} x {} texels, {}, {} directions; factorization {}\n\n", report.material.dump(),
                    factored.size, factored.size, diskMappingName(factored.mapping), report.directions,
                    factorizationName(report.method));
    table += fmt::format("{:>5} {:>11} {:>11} {:>11} {:>10} {:>10} {:>10} {:>10}", "terms", "value R",
                         "value G", "value B", "Frobenius", "RMS", "RMS rel.", "expected");
    for (const BrdfReport::Curve& light : report.radiance)
        table += fmt::format("  {:>12}", stemOf(light.name).substr(0, 12));
    table += "\n";
    for (const int count : someTermCounts(factored.terms)) {
        const auto k = size_t(count - 1);
        table += fmt::format("{:5}", count);
        for (const float value : factored.eigenvalues[k]) table += fmt::format(" {:11.5g}", value);
        for (const BrdfReport::Curve* curve :
             {&report.frobenius, &report.absolute, &report.relative, &report.expected})
            table += fmt::format(" {:10.4g}", curve->values[k]);
        for (const BrdfReport::Curve& light : report.radiance)
            table += fmt::format("  {:12.4g}", light.values[k]);
        table += "\n";
    }
    return table;
}

} // namespace relume
