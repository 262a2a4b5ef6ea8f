#include "precompute/layout/conversion.h"

#include "engine/base/error.h"
#include "precompute/layout/layout_scale.h"
#include "precompute/layout/layouts.h"
#include "precompute/transport/light_spectrum.h"
#include "precompute/transport/norm_sum.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

std::vector<MaterialSet*> setsOf(Asset& asset) {
    std::vector<MaterialSet*> sets;
    for (AssetPart& part : asset.parts)
        for (MaterialSet& set : part.sets) sets.push_back(&set);
    return sets;
}

uint64_t bytesOf(const std::vector<MaterialSet*>& sets) {
    uint64_t bytes = 0;
    for (const MaterialSet* set : sets) bytes += bytesOf(set->transport);
    return bytes;
}

// Encodes rows as the options ask; returns the RMS error over all vertices, relative to the sets'
// normalization.
double compress(const Asset& asset, const std::vector<MaterialSet*>& sets, const LayoutOptions& options,
                ConversionPasses& passes) {
    RowSource source{sets, lightSpectrum(asset.faceSize), {}, asset.bounces > 0};
    uint64_t vertices = 0;
    for (const MaterialSet* set : sets) {
        source.norms.push_back(transportNorm(rowsOf(set->transport), source.spectrum));
        vertices += rowsOf(set->transport).vertices;
    }
    LayoutTarget target{{}, *options.error * *options.error * double(vertices)};
    if (options.bytesPerVertex) target.bytes = *options.bytesPerVertex * double(vertexCount(asset));
    const double squared =
        std::visit([&](const auto& layout) { return convertRows(layout, source, target, passes); },
                   emptyTransport(options.layout, 0, 0));
    return std::sqrt(squared / double(std::max<uint64_t>(1, vertices)));
}

} // namespace

Conversion convertLayout(Asset& asset, const LayoutOptions& given, const ConversionReport& progress,
                         std::optional<int> coefficients) {
    makeSumsDeterministic();
    LayoutOptions options = given;
    if (!options.error) options.error = defaultLayoutError(asset);
    const std::vector<MaterialSet*> sets = setsOf(asset);
    const bool areRows = std::ranges::all_of(
        sets, [](const MaterialSet* set) { return layoutOf(set->transport) == TransportLayout::Rows; });
    const bool areShorter = coefficients && *coefficients < asset.coefficients;
    const bool needsRows = areShorter || !areRows;
    ConversionPasses passes(
        sets, (needsRows ? 1 : 0) + (isCompressed(options.layout) ? kConversionPasses : 0), progress);
    Conversion conversion;
    conversion.bytesBefore = bytesOf(sets);
    if (areShorter) asset.coefficients = *coefficients;
    if (needsRows) makeRows(sets, asset, isCompressed(options.layout), passes);
    if (isCompressed(options.layout)) {
        conversion.error = compress(asset, sets, options, passes);
        if (!std::isfinite(*conversion.error)) throw Error(kTooLarge);
        // Earlier errors remain and are nearly independent of the new ones, so squares add.
        const double before = asset.layout ? asset.layout->error : 0;
        asset.layout = recordOf(options, std::hypot(before, *conversion.error));
    }
    conversion.bytesAfter = bytesOf(sets);
    return conversion;
}

} // namespace relume
