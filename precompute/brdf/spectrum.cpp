#include "precompute/brdf/spectrum.h"

#include <algorithm>
#include <cmath>

namespace relume {

namespace {

// Returns a Gaussian with different inverse widths below and above its peak.
float lobe(float wavelength, float peak, float below, float above) {
    const float t = (wavelength - peak) * (wavelength < peak ? below : above);
    return std::exp(-0.5f * t * t);
}

// Returns the multi-lobe fit of the paper's listing 1.
vec3 matchingFunctions(float w) {
    return {0.362f * lobe(w, 442.0f, 0.0624f, 0.0374f) + 1.056f * lobe(w, 599.8f, 0.0264f, 0.0323f) -
                0.065f * lobe(w, 501.1f, 0.0490f, 0.0382f),
            0.821f * lobe(w, 568.8f, 0.0213f, 0.0247f) + 0.286f * lobe(w, 530.9f, 0.0613f, 0.0322f),
            1.217f * lobe(w, 437.0f, 0.0845f, 0.0278f) + 0.681f * lobe(w, 459.0f, 0.0385f, 0.0725f)};
}

// Converts XYZ under equal energy to linear sRGB: to Bradford's cone responses, scaled from those of (1, 1,
// 1) to those of D65, and back. Matrices are written by rows.
mat3 adaptedToSrgb() {
    const mat3 bradford = glm::transpose(
        mat3(0.8951f, 0.2664f, -0.1614f, -0.7502f, 1.7135f, 0.0367f, 0.0389f, -0.0685f, 1.0296f));
    const mat3 srgb = glm::transpose(mat3(3.2404542f, -1.5371385f, -0.4985314f, -0.9692660f, 1.8760108f,
                                          0.0415560f, 0.0556434f, -0.2040259f, 1.0572252f));
    const vec3 gain = (bradford * vec3(0.95047f, 1, 1.08883f)) / (bradford * vec3(1));
    const mat3 scaling(vec3(gain.x, 0, 0), vec3(0, gain.y, 0), vec3(0, 0, gain.z));
    return srgb * glm::inverse(bradford) * scaling * bradford;
}

} // namespace

std::vector<vec3> srgbWeights(std::span<const float> wavelengths) {
    const size_t count = wavelengths.size();
    std::vector<vec3> weights(count);
    vec3 total(0);
    for (size_t i = 0; i < count; i++) {
        const float width = (wavelengths[std::min(i + 1, count - 1)] - wavelengths[i > 0 ? i - 1 : 0]) / 2;
        weights[i] = matchingFunctions(wavelengths[i]) * width;
        total += weights[i];
    }
    const mat3 toSrgb = adaptedToSrgb();
    vec3 white(0); // one, except for rounding
    for (vec3& weight : weights) {
        weight = toSrgb * (weight / total);
        white += weight;
    }
    for (vec3& weight : weights) weight /= white;
    return weights;
}

} // namespace relume
