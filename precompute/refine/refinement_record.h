// The goal of a refinement, and its result.
#pragma once

#include <cstdint>

namespace relume {

// Range of --refine.
constexpr double kLeastRefinementError = 0.001, kMostRefinementError = 1;

// Limit on vertices of all refined parts; each takes about two kilobytes of memory during refinement.
constexpr uint64_t kMostRefinedVertices = 1u << 20;

// Limits of --refine auto: it refines parts of fewer than kCoarseVertices, up to kMostAutoGiven vertices
// together, until the error is kAutoRefinementError or kMostAutoVertices are added (docs/refinement.md).
constexpr uint64_t kCoarseVertices = 10000;
constexpr double kAutoRefinementError = 0.01;
constexpr uint64_t kMostAutoVertices = 20000, kMostAutoGiven = 200000;

// Errors are estimates for transport interpolated between vertices: the RMS over the surface of all refined
// parts of the error in reflected light, weighted by the mean spectrum of light
// (precompute/transport/light_spectrum.h), relative to the RMS of that light. Parts that reflect more than a
// white surface count as if they reflected as much.
struct RefinementRecord {
    double wanted = 0;                        // kLeastRefinementError to kMostRefinementError
    double startError = 0;                    // of the input meshes
    double error = 0;                         // result; above `wanted` if the limits of refine() were reached
    uint64_t startVertices = 0, vertices = 0; // of all parts, refined or not
    bool isAuto = false;                      // only coarse parts are refined

    bool operator==(const RefinementRecord&) const = default;
};

} // namespace relume
