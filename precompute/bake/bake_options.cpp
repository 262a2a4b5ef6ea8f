#include "precompute/bake/bake_options.h"

#include "engine/base/error.h"
#include "engine/transport/asset_check.h"
#include "precompute/brdf/tabulation.h"

#include <algorithm>
#include <fmt/format.h>
#include <initializer_list>

namespace relume {

static void expectRange(const char* option, int value, int low, int high) {
    if (value < low || value > high)
        throw UsageError(fmt::format("{}: expected {} to {}, found {}", option, low, high, value));
}

static void expectOneOf(const char* option, int value, const char* names, std::initializer_list<int> valid) {
    if (std::find(valid.begin(), valid.end(), value) == valid.end())
        throw UsageError(fmt::format("{}: expected {}, found {}", option, names, value));
}

int defaultCoefficients(TransportLayout layout) { return layout == TransportLayout::Rows ? 96 : 384; }

FactorizationOptions defaultFactorization() { return {.terms = 8, .method = Factorization::NonNegative}; }

int BakeOptions::mostTransportSamples() const {
    const int ratio = visibilitySize / std::max(faceSize, 1); // sizes may not be validated yet
    return std::max(ratio * ratio, 1);
}

void BakeOptions::validate() const {
    expectRange("--terms", factorization.terms, 1, kMostTerms);
    if (factorization.method == Factorization::Normalized && factorization.terms != 1)
        throw UsageError(
            fmt::format("--terms: factorization \"normalized\" has one term, not {}", factorization.terms));
    expectRange("--map-size", mapSize, kMinMapSize, kMaxMapSize);
    expectOneOf("--face-size", faceSize, "32 or 64", {32, 64});
    expectOneOf("--visibility-size", visibilitySize, "64, 128 or 256", {64, 128, 256});
    expectOneOf("--transport-samples", transportSamples, "1, 4 or 16", {1, 4, 16});
    expectRange("--bounces", bounces, 0, kMostBounces);
    expectRange("--coefficients", coefficients, 1, 6 * faceSize * faceSize);
    if (refinement &&
        !(refinement->wanted >= kLeastRefinementError && refinement->wanted <= kMostRefinementError))
        throw UsageError(fmt::format("--refine: expected an error of {} to {}, found {}",
                                     kLeastRefinementError, kMostRefinementError, refinement->wanted));
    if (transportSamples > mostTransportSamples())
        throw UsageError(fmt::format(
            "--transport-samples {}: expected at most {}, the visibility texels in a lighting texel; raise "
            "--visibility-size or lower --face-size",
            transportSamples, mostTransportSamples()));
}

} // namespace relume
