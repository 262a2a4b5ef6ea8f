// Selection of the light entries that are kept.
#pragma once

#include <optional>

namespace relume {

// The largest magnitude of a quantized coefficient, and the paper's threshold in the same unit.
constexpr int kLightMaximum = 32767;
constexpr int kPaperLightThreshold = 1024;

// The default count. With area weights, so many entries lose less of an image than any other step
// (docs/errors.md). The paper's threshold keeps 24 to 600 entries and loses up to 30 % where small lamps
// outshine a room.
constexpr int kDefaultLightCount = 1024;

// How light entries are selected. An entry's weight is its largest |component|, times, if `areaWeighted`, the
// share of a face that its Haar function covers, a power of two (Ng, Ramamoorthi, Hanrahan: All-Frequency
// Shadows Using Non-linear Wavelet Lighting Approximation, 2003, "area-weighted selection": the response of a
// smooth receiver to a wavelet is proportional to its area). Weights below 2^-126 count as 0, and such
// entries are never kept.
struct LightSelection {
    // If given, keeps entries of at least (threshold - ½) / kLightMaximum of the largest weight; 0 keeps all.
    std::optional<int> threshold = std::nullopt;
    // Otherwise the `count` entries of largest weight are kept, at least 1; of equals the lower index.
    int count = kDefaultLightCount;
    // None: weighted by area if entries are counted, not with a threshold.
    std::optional<bool> areaWeighted = std::nullopt;

    bool isAreaWeighted() const { return areaWeighted.value_or(!threshold); }
    bool operator==(const LightSelection&) const = default;
};

// Returns the share of the largest weight that an entry must have to be kept.
inline float shareOf(int threshold) {
    return threshold > 0 ? (float(threshold) - 0.5f) / float(kLightMaximum) : 0;
}

} // namespace relume
