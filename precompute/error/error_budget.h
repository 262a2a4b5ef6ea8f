// How errors of single stages add up to the error of an image.
#pragma once

#include "precompute/error/stage_radiance.h"

namespace relume {

// What one source does. With d its change of every point's radiance and D the sum of all changes, which is
// the drawn radiance minus the truth:
struct SourceError {
    double rms = 0;   // √ mean d², relative to the root mean square of the truth
    double share = 0; // ⟨d, D⟩ / ⟨D, D⟩, of the squared total; below 0 where it makes up for others
};

struct ErrorBudget {
    double level = 0;          // root mean square of the truth's radiance, over points and channels
    double total = 0;          // √ mean D², relative to that
    double uncertainty = 0;    // standard error of `total`, were points a random sample of a finer image's
    double rootSumSquares = 0; // of the sources' rms: `total`, were they independent of each other
    std::array<SourceError, kErrorSources> sources;
};

// Of points under one light, which count alike. Shares sum to 1, unless the total is 0.
ErrorBudget errorBudget(std::span<const StageRadiance> points);

} // namespace relume
