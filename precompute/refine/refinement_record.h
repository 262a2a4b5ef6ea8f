// What was asked of a refinement, and what came of it.
#pragma once

#include <cstdint>

namespace relume {

// What --refine may ask for.
constexpr double kLeastRefinementError = 0.001, kMostRefinementError = 1;

// The most vertices of all refined parts: each takes about a kilobyte of memory meanwhile.
constexpr uint64_t kMostRefinedVertices = 1u << 20;

// Limits of --refine auto: it refines parts of fewer than kCoarseVertices, as long as they have no more than
// kMostAutoGiven together, to kAutoRefinementError or by kMostAutoVertices (docs/refinement.md).
constexpr uint64_t kCoarseVertices = 10000;
constexpr double kAutoRefinementError = 0.01;
constexpr uint64_t kMostAutoVertices = 20000, kMostAutoGiven = 200000;

// Errors are those of interpolating transport between vertices, estimated: over the surface of all refined
// parts, the root mean square of what interpolation does to reflected light as light of all scales weighs it
// (precompute/transport/light_spectrum.h), relative to the root mean square of that light.
struct RefinementRecord {
    double wanted = 0;     // kLeastRefinementError to kMostRefinementError
    double startError = 0; // of the meshes as they came
    double error = 0;      // as it was left: above `wanted` where the limits of refine() were met
    uint64_t startVertices = 0, vertices = 0; // of all parts, refined or not
    bool isAuto = false;                      // coarse parts alone are refined

    bool operator==(const RefinementRecord&) const = default;
};

} // namespace relume
