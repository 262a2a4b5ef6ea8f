#include "precompute/bake/bake_preset.h"

#include "precompute/bake/baked_options.h"

namespace relume {

namespace {

// In triangles. The paper mentions a simplified occluder but no number.
constexpr size_t kPaperOccluder = 5000;

// Two bounces add two fifths to the time of a bake (docs/bounces.md).
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
