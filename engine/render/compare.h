// Differences between two images of equal size, and the colors that show them.
#pragma once

#include "engine/image/image.h"
#include "engine/math/vector.h"

namespace relume {

// Measures of the difference of an image from a reference.
struct ImageDifference {
    double relativeRmse;  // sqrt(Σ(a-b)² / Σb²) over linear RGB; b is the reference
    double psnr;          // dB, peak = largest value of b; infinite for equal images
    double maxDifference; // largest |a-b| over pixels and channels
    double flip;          // mean ꟻLIP error in [0, 1] after toneMap (ACES, exposure 0)
};

// Compares RGB only. Throws Error if sizes differ, a value is not finite or the reference is black.
ImageDifference compareImages(const Image& image, const Image& reference);

// Returns a linear color: from black (0) over blue, purple and orange to yellow (1 and more). GLSL twin:
// shaders/compare.frag.
vec3 heatColor(float heat);

} // namespace relume
