#include "precompute/bake/bake_preset.h"

#include "precompute/bake/baked_options.h"

namespace relume {

namespace {

// Triangles. The paper tells of a simplified occluder and of no number.
constexpr size_t kPaperOccluder = 5000;

// Two take two fifths of a bake's time more (docs/bounces.md).
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
        // Refined where parts came coarse, it is not recorded where none did.
        if (wanted.refinement && !baked) wanted.refinement.reset();
        if (describeOptions(options) == describeOptions(wanted)) return preset;
    }
    return std::nullopt;
}

} // namespace relume
