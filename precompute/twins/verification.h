// Verifies a bake stage by stage against the CPU twins and Embree.
#pragma once

#include "engine/light/environment.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

#include <optional>

namespace relume {

// Relative errors of the rows that were sampled, computed as those of Verification.
struct RowErrors {
    double wavelet = 0;      // lost by keeping N
    double quantization = 0; // against the coefficients that they keep
};

// Relative errors are sqrt(Σ|a - b|² / Σ|b|²) over all sampled vertices and terms, where b is the CPU's.
struct Verification {
    uint64_t samples = 0;
    double visibilityMismatch = 0; // share of texels above the horizon: device against Embree
    double transportError = 0;     // all coefficients: device against CPU twin, given the device's visibility
    double layoutError = 0;        // stored transport against all coefficients
    double bounceError = 0;        // of bounced rows, if light bounces: against the twin of the last bounce
    std::optional<RowErrors> rows; // unless all sampled sets have bases
    double brdfError = 0;     // cosine-weighted relative RMS of the K terms, mean over samples' materials
    uint64_t relightBits = 0; // number of vertices, of all, whose K-tuple differs between device and CPU
    double totalError = 0;    // stored transport against uncompressed transport with Embree's visibility
};

// Recomputes `samples` random vertices, the same each time, and relights all vertices under `prepared`
// (prepareForSampling), rotated by `rotation` radians, with the default light selection.
Verification verify(const vk::Device& device, const Asset& asset, const Environment& prepared, float rotation,
                    int samples);

} // namespace relume
