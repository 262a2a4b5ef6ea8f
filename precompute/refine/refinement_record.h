// What was asked of a refinement, and what came of it.
#pragma once

#include <cstdint>

namespace relume {

// What --refine may ask for.
constexpr double kLeastRefinementError = 0.001, kMostRefinementError = 1;

// Of all parts: what a refinement remembers of each takes a kilobyte.
constexpr uint64_t kMostRefinedVertices = 1u << 20;

// Errors are those of interpolating transport between vertices, estimated: over the surface of all parts, the
// root mean square of what interpolation does to reflected light as light of all scales weighs it
// (precompute/layout/light_spectrum.h), relative to the root mean square of that light.
struct RefinementRecord {
    double wanted = 0;     // kLeastRefinementError to kMostRefinementError
    double startError = 0; // of the meshes as they came
    double error = 0;      // as it was left: above `wanted` where the limits of refine() were met
    uint64_t startVertices = 0, vertices = 0; // of all parts

    bool operator==(const RefinementRecord&) const = default;
};

} // namespace relume
