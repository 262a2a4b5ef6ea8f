#include "precompute/bake/bake_options.h"

#include "engine/base/error.h"
#include "engine/transport/asset_check.h"
#include "precompute/bake/baked_options.h"
#include "precompute/brdf/tabulation.h"
#include "precompute/visibility/occluder.h"

#include <algorithm>
#include <fmt/core.h>
#include <initializer_list>

namespace relume {

namespace {

// In triangles. The paper's numbers have no unit (docs/paper.md).
constexpr size_t kPaperOccluder = 5000;

// Two bounces nearly double the time of a bake on two cores, and are most of what a picture lacks without
// (docs/bounces.md).
constexpr int kDefaultBounces = 2;

BakeOptions paperOptions() {
    BakeOptions options;
    options.layout = {.layout = TransportLayout::Rows};
    options.factorization = {.terms = 4, .method = Factorization::Paper};
    options.coefficients = 96;
    options.mapping = DiskMapping::Orthographic;
    options.visibilityMethod = VisibilityMethod::Raster;
    options.transportSamples = 16;
    options.occluderTriangles = kPaperOccluder;
    return options;
}

} // namespace

static void expectRange(const char* option, int value, int low, int high) {
    if (value < low || value > high)
        throw UsageError(fmt::format("{}: expected {} to {}, found {}", option, low, high, value));
}

static void expectOneOf(const char* option, int value, const char* names, std::initializer_list<int> valid) {
    if (std::find(valid.begin(), valid.end(), value) == valid.end())
        throw UsageError(fmt::format("{}: expected {}, found {}", option, names, value));
}

int defaultCoefficients(TransportLayout layout) { return layout == TransportLayout::Rows ? 96 : 384; }

int BakeOptions::mostTransportSamples() const {
    const int ratio = visibilitySize / std::max(faceSize, 1); // sizes may not be validated yet
    return std::max(ratio * ratio, 1);
}

void BakeOptions::validate() const {
    if (const auto terms = factorization.terms) {
        expectRange("--terms", *terms, 1, kMostTerms);
        if (factorization.method == Factorization::Normalized && *terms != 1)
            throw UsageError(
                fmt::format("--terms: factorization \"normalized\" has one term, not {}", *terms));
    }
    expectRange("--map-size", mapSize, kMinMapSize, kMaxMapSize);
    expectOneOf("--face-size", faceSize, "32 or 64", {32, 64});
    expectOneOf("--visibility-size", visibilitySize, "64, 128 or 256", {64, 128, 256});
    expectOneOf("--transport-samples", transportSamples, "1, 4 or 16", {1, 4, 16});
    expectRange("--bounces", bounces, 0, kMostBounces);
    expectRange("--coefficients", coefficients, 1, 6 * faceSize * faceSize);
    if (occluderTriangles > 0 && occluderTriangles < kLeastOccluderTriangles)
        throw UsageError(fmt::format("--occluder: expected {} triangles or more, found {}",
                                     kLeastOccluderTriangles, occluderTriangles));
    if (const auto error = layout.error; error && !(*error >= kLeastLayoutError && *error <= 1))
        throw UsageError(fmt::format("--error: expected {} to 1, found {}", kLeastLayoutError, *error));
    if (const auto bytes = layout.bytesPerVertex; bytes && !(*bytes >= 1 && *bytes <= kMostLayoutBytes))
        throw UsageError(fmt::format("--budget: expected 1 to {}, found {}", kMostLayoutBytes, *bytes));
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

BakeOptions presetOptions(BakePreset preset) {
    if (preset == BakePreset::Paper) return paperOptions();
    BakeOptions options;
    options.refinement = RefinementRecord{.wanted = kAutoRefinementError, .isAuto = true};
    options.bounces = kDefaultBounces;
    options.areBouncesAuto = true;
    return options;
}

std::string_view presetName(BakePreset preset) { return preset == BakePreset::Paper ? "paper" : "default"; }

std::optional<BakePreset> presetOf(const BakeOptions& options) {
    for (const BakePreset preset : kBakePresets) {
        BakeOptions wanted = presetOptions(preset);
        const auto& baked = options.refinement;
        if (wanted.refinement && baked && baked->isAuto && baked->wanted == wanted.refinement->wanted)
            wanted.refinement = baked;
        // Automatic refinement is not recorded if no part was coarse.
        if (wanted.refinement && !baked) wanted.refinement.reset();
        if (describeOptions(options) == describeOptions(wanted)) return preset;
    }
    return std::nullopt;
}

} // namespace relume
