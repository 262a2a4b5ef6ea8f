// A bake held against the CPU twins and Embree, stage by stage.
#pragma once

#include "engine/light/environment.h"
#include "engine/transport/asset.h"
#include "engine/vk/device.h"

namespace relume {

// Relative errors are sqrt(Σ|a - b|² / Σ|b|²) over all sampled vertices and terms; b is the CPU's.
struct Verification {
    uint64_t samples = 0;
    double visibilityMismatch = 0; // fraction of texels above the horizon: device against Embree
    double transportError = 0;     // all coefficients: device against CPU twin on the device's visibility
    double layoutError = 0;        // the asset's transport against all coefficients: what its layout loses
    double waveletError = 0;       // of rows: lost by keeping N
    double quantizationError = 0;  // of rows: against the coefficients they keep
    double bounceError = 0;   // of bounced rows, where light bounces: against the twin of the last bounce
    double brdfError = 0;     // cos-weighted relative RMS of the K terms, mean over samples' materials
    uint64_t relightBits = 0; // vertices, of all, whose K-tuple differs between device and CPU
    double totalError = 0;    // the asset's rows against uncompressed transport under Embree's visibility
};

// Recomputes `samples` random vertices (seeded, so the same ones every time), and relights all vertices under
// `prepared` (prepareForSampling), turned by `rotation` radians, with the light threshold's default.
Verification verify(const vk::Device& device, const Asset& asset, const Environment& prepared, float rotation,
                    int samples);

} // namespace relume
