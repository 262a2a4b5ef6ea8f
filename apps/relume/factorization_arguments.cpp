#include "apps/relume/factorization_arguments.h"

#include "engine/base/error.h"

#include <fmt/core.h>

namespace relume {

namespace {

constexpr std::string_view kAuto = "auto:";

// Returns the error E of "auto:E".
float wantedErrorFrom(const std::string& text) {
    float error;
    if (CLI::detail::lexical_cast(text.substr(kAuto.size()), error) && error > 0 && error <= 1) return error;
    throw UsageError(
        fmt::format("--terms: expected an error above 0 and up to 1 after auto:, found \"{}\"", text));
}

int termsFrom(const std::string& text) {
    int terms;
    if (CLI::detail::lexical_cast(text, terms) && terms >= 1 && terms <= kMostTerms) return terms;
    throw UsageError(fmt::format("--terms: expected 1 to {}, or auto:E for an error of E; found \"{}\"",
                                 kMostTerms, text));
}

} // namespace

void FactorizationArguments::add(CLI::App& command, const std::optional<FactorizationOptions>& defaults) {
    CLI::Option* terms =
        command
            .add_option(
                "-K,--terms", mTerms,
                "BRDF terms, 1 to 32; or auto:E, the fewest whose expected relative error of reflected "
                "radiance is at most E")
            ->type_name("K");
    CLI::Option* method =
        command
            .add_option(
                "--factorization", mMethod,
                "What the terms make least: errors of f cos cos without a negative map (nonnegative: the "
                "best pictures with the residual), of radiance as it is seen (environment: the best "
                "without), of f cos cos (cosine), of f (paper); or one term of norms (normalized)")
            ->type_name("METHOD")
            ->check(CLI::IsMember({"nonnegative", "environment", "cosine", "paper", "normalized"}));
    if (defaults) {
        terms->default_str(defaults->terms
                               ? std::to_string(*defaults->terms)
                               : fmt::format("{}, or {} nonnegative ones of an anisotropic material",
                                             kIsotropicTerms, kAnisotropicTerms));
        method->default_str(std::string(factorizationName(defaults->method)));
    }
    command
        .add_option(
            "--map", mMapping,
            "Layout of the maps: orthographic, polar-sine or equal-area (default: orthographic for paper and "
            "normalized, else equal-area)")
        ->type_name("MAP")
        ->check(CLI::IsMember({"orthographic", "polar-sine", "equal-area"}));
}

void FactorizationArguments::resolve(const FactorizationOptions& otherwise, DiskMapping map) {
    options = otherwise;
    mapping = map;
    if (mMethod) {
        options.method = *factorizationFromName(*mMethod);
        mapping = defaultMapping(options.method);
    }
    if (mMapping) mapping = *diskMappingFromName(*mMapping);
    const bool isAutomatic = mTerms && mTerms->starts_with(kAuto);
    if (mTerms) {
        options.terms = isAutomatic ? kMostTerms : termsFrom(*mTerms);
        options.wantedError.reset();
    } else if (options.method == Factorization::Normalized) {
        options.terms.reset();
    }
    if (!isAutomatic) return;
    if (options.method == Factorization::Normalized)
        throw UsageError(fmt::format("--terms {}: factorization \"normalized\" has one term", *mTerms));
    options.wantedError = wantedErrorFrom(*mTerms);
    // Nonnegative terms are not nested, so their number cannot be chosen by error.
    if (options.method == Factorization::NonNegative && !mMethod) options.method = Factorization::Environment;
}

} // namespace relume
