// From tabulated BRDFs to their K largest terms. docs/factorization.md compares the ways to do it.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "precompute/brdf/tabulation.h"

#include <optional>
#include <span>
#include <string_view>

namespace relume {

enum class Factorization {
    // Eigenpairs of the table of f as it is (all-frequency relighting, 2004, section 3 and appendix).
    Paper,
    // Of f times cosθ √solid angle on either side: least squares of f cosθi cosθo over both hemispheres.
    Cosine,
    // Singular triplets of f weighted by what environments and pixels ask for (light_metric.h): least squares
    // of reflected radiance as it is seen.
    Environment,
    // Least squares of f cosθi over the pixels of a convex object, with maps that are nowhere negative: sums
    // cannot undershoot, for a larger error. All channels share their light maps, which are gray.
    NonNegative,
    // One term, the normalized decomposition (Kautz and McCool 1999): the view map is the norm of f over
    // incoming directions, here of p = 2, the light map the mean over outgoing directions of f over it.
    Normalized,
};

// "paper", "cosine", "environment", "nonnegative" and "normalized".
std::string_view factorizationName(Factorization method);
std::optional<Factorization> factorizationFromName(std::string_view name);

// Paper and Normalized, the methods of publications: they factor orthographic tables of f at texel centers,
// and the residual is not part of them.
bool isPublished(Factorization method);

// Returns what the tables that a method factors hold: f at texel centers if it is published, else its means.
TexelValue texelValueOf(Factorization method);

struct FactorizationOptions {
    int terms = 4; // K, 1 to kMaxTerms; 1 for Normalized
    Factorization method = Factorization::Environment;
    // Instead of `terms` the least number of them, up to `terms`, whose expectedErrors() of every layer are
    // at or below this; where all of them are not enough, all, and the log says so. Not for NonNegative,
    // whose terms are only good together.
    std::optional<float> wantedError;

    bool operator==(const FactorizationOptions&) const = default;
};

// Factors the tables jointly: a layer each, one set of light maps. Every table counts alike, whatever its
// size. A single reciprocal BRDF in Paper's or Cosine's way is factored by eigenpairs of largest |λ| per
// channel: its light map is √|λ| v over the weights, the view map that times the sign of λ. All else is by
// singular triplets. Terms below 1e-5 of the first are dropped, so a diffuse BRDF has one. All tables have
// the same size and mapping. Deterministic.
FactoredBrdf factorize(std::span<const BrdfTable> tables, const FactorizationOptions& options);
FactoredBrdf factorize(const BrdfTable& table, const FactorizationOptions& options);

} // namespace relume
