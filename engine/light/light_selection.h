// Which coefficients of the light are kept.
#pragma once

#include <optional>

namespace relume {

// Largest |quantized coefficient|, and the paper's threshold, of kLightMaximum.
constexpr int kLightMaximum = 32767;
constexpr int kPaperLightThreshold = 1024;

// With area weights so many lose less of an image than any other step (docs/errors.md). The paper's threshold
// keeps 24 to 600 entries, and loses up to 30 % where small lamps outshine a room.
constexpr int kDefaultLightCount = 512;

// An entry's weight is the largest |component| of its three channels; with `areaWeighted` times the share of
// a face that its Haar function covers, a power of two (Ng, Ramamoorthi, Hanrahan: All-Frequency Shadows
// Using Non-linear Wavelet Lighting Approximation, 2003, "area-weighted selection": a smooth receiver answers
// to a wavelet in proportion to its area). Weights below 2^-126 are 0, and such entries are never kept.
struct LightSelection {
    // If given, entries of at least (threshold - ½) / kLightMaximum of the largest weight are kept: all, with
    // 0.
    std::optional<int> threshold = std::nullopt;
    // Else the `count` entries of the largest weight; of equals those of lower index. At least 1.
    int count = kDefaultLightCount;
    // None: counted entries are, as the paper's threshold is not.
    std::optional<bool> areaWeighted = std::nullopt;

    bool isAreaWeighted() const { return areaWeighted.value_or(!threshold); }
    bool operator==(const LightSelection&) const = default;
};

// The share of the largest weight that a kept entry has at least.
inline float shareOf(int threshold) {
    return threshold > 0 ? (float(threshold) - 0.5f) / float(kLightMaximum) : 0;
}

} // namespace relume
