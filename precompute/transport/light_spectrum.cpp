#include "precompute/transport/light_spectrum.h"

#include "engine/math/cubemap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace relume {

namespace {

// Root mean square of environments' Haar coefficients by level, relative to the average: first the average,
// then wavelets of 1, 2, 4, … a side. Mean over nine environments, three of them indoors, at 64 texels a
// side.
constexpr std::array<double, 7> kAmplitudes = {1, 0.53, 0.25, 0.163, 0.114, 0.085, 0.043};
constexpr double kPower = 0.7;

} // namespace

std::vector<float> lightSpectrum(int faceSize) {
    std::array<float, kAmplitudes.size()> weights;
    for (size_t level = 0; level < weights.size(); level++)
        weights[level] = float(std::pow(kAmplitudes[level], kPower));
    std::vector<float> spectrum;
    for (int face = 0; face < kCubeFaces; face++)
        for (int y = 0; y < faceSize; y++)
            for (int x = 0; x < faceSize; x++) {
                const size_t level = std::bit_width(unsigned(std::max(x, y)));
                spectrum.push_back(weights[std::min(level, weights.size() - 1)]);
            }
    return spectrum;
}

} // namespace relume
