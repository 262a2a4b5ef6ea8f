// Breaks down the error of an image into the contributions of its sources.
#pragma once

#include "precompute/error/stage_radiance.h"

namespace relume {

// The contribution of one source. d is the change of a point's radiance by making the source exact, D the sum
// of all changes, which is the drawn radiance minus the truth:
struct SourceError {
    double rms = 0;   // √ mean d², relative to the RMS of the truth
    double share = 0; // ⟨d, D⟩ / ⟨D, D⟩, of the squared total; negative if it compensates others
};

struct ErrorBudget {
    double level = 0;          // RMS of the truth's radiance, over points and channels
    double total = 0;          // √ mean D², relative to `level`
    double uncertainty = 0;    // standard error of `total`, if points are a random sample
    double rootSumSquares = 0; // of the sources' rms: `total` if sources were independent
    std::array<SourceError, kErrorSources> sources;
};

// Returns the budget of points under one light, equally weighted. Shares sum to 1, unless the total is 0.
ErrorBudget errorBudget(std::span<const StageRadiance> points);

} // namespace relume
