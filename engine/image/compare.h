// Differences between two images of equal size.
#pragma once

#include "engine/image/image.h"

namespace relume {

struct ImageDifference {
    double relativeRmse;  // sqrt(Σ(a-b)² / Σb²) over linear RGB; b is the reference
    double psnr;          // dB, peak = largest value of b
    double maxDifference; // largest |a-b| over pixels and channels
    double flip;          // mean ꟻLIP error in [0, 1] of tone-mapped images (Andersson et al. 2020)
};

// Throws Error when the sizes differ or the reference is black.
ImageDifference compareImages(const Image& image, const Image& reference);

} // namespace relume
