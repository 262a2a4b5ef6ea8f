// From a tabulated BRDF to its K largest terms (all-frequency relighting, 2004, section 3 and appendix).
#pragma once

#include "engine/scene/factored_brdf.h"
#include "precompute/brdf/tabulation.h"

namespace relume {

struct FactorizationOptions {
    int terms = 4; // K, 1 to kMaxTerms
};

// Eigenpairs of largest |λ|, per channel. The light map is √|λ| v, the view map √|λ| v times the sign of
// λ. An unsymmetric table (not reciprocal) is factored by SVD instead, said so in the log. Terms below
// 1e-6 of the first are dropped, so a diffuse BRDF has one. Deterministic.
FactoredBrdf factorize(const BrdfTable& table, const FactorizationOptions& options);

// sqrt(Σ (f̃ - f)² cos²θi cos²θo / Σ f² cos²θi cos²θo) over `pairs` random pairs of directions, uniform on
// the hemisphere, mean over channels: the cos-weighted relative RMS of K terms as bilinear lookups return
// them.
float factorizationError(const Brdf& brdf, const FactoredBrdf& factored, int pairs = 80000);

} // namespace relume
