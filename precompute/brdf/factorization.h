// Factors tabulated BRDFs into K terms; docs/factorization.md compares the methods.
#pragma once

#include "engine/scene/factored_brdf.h"

#include <optional>
#include <span>
#include <string_view>

namespace relume {

struct BrdfTable; // tabulation.h
enum class TexelValue;

enum class Factorization {
    // Eigenpairs of the tabulated f, unweighted (the paper, section 3 and appendix).
    Paper,
    // Eigenpairs of f weighted by cosθ √solid angle on either side: least squares of f cosθi cosθo over both
    // hemispheres.
    Cosine,
    // Singular triplets of f weighted by lightMetric() and viewMetric(): least squares of visible reflected
    // radiance under typical environments.
    Environment,
    // Least squares of f cosθi over the pixels of a convex object, with nonnegative maps: sums cannot
    // undershoot, but the error is larger. Grazing views of anisotropic BRDFs count for more. All
    // channels share gray light maps. The terms reflect as much of an even light into every view as f.
    NonNegative,
    // One term, the normalized decomposition (Kautz and McCool 1999), with p = 2: the view map is the norm of
    // f over incoming directions, the light map the mean over outgoing directions of f divided by the view
    // map.
    Normalized,
};

// Returns "paper", "cosine", "environment", "nonnegative" or "normalized".
std::string_view factorizationName(Factorization method);
std::optional<Factorization> factorizationFromName(std::string_view name);

// Returns whether the method is one from the literature, Paper or Normalized. These factor orthographic
// tables of f at texel centers, and the residual is not part of them.
bool isPublished(Factorization method);

// Returns the layout of maps for a method unless it is given: published tables are orthographic; errors
// weighted by area do best with equal-area texels.
DiskMapping defaultMapping(Factorization method);

// Returns what a method's tables hold: f at texel centers for published methods, otherwise means over texels.
TexelValue texelValueOf(Factorization method);

// K of nonnegative terms unless it is given, of isotropic and of anisotropic BRDFs: the best image quality
// for its size and time (docs/residual.md). Other methods have kIsotropicTerms.
constexpr int kIsotropicTerms = 8, kAnisotropicTerms = 9;

struct FactorizationOptions {
    // K, 1 to kMostTerms. If not set: 1 for Normalized, else kIsotropicTerms or kAnisotropicTerms.
    std::optional<int> terms;
    Factorization method = Factorization::Environment;
    // If set, uses the least number of terms, up to `terms`, with which expectedErrors() of every layer are
    // at most this; if there is none, all `terms`, and the log says so. Not for NonNegative, whose terms are
    // only good together.
    std::optional<float> wantedError;

    bool operator==(const FactorizationOptions&) const = default;
};

// Factors the tables jointly: one set of light maps, a layer of view maps per table. All tables have one size
// and mapping, and are weighted equally whatever their magnitude. A single reciprocal BRDF is factored by
// Paper and Cosine into eigenpairs of largest |λ| per channel: the light map is √|λ| v divided by the
// weights, the view map the same times the sign of λ. Otherwise singular triplets are used. Terms below 1e-5
// of the first are dropped, so that a diffuse BRDF has one. Deterministic.
FactoredBrdf factorize(std::span<const BrdfTable> tables, const FactorizationOptions& options);
FactoredBrdf factorize(const BrdfTable& table, const FactorizationOptions& options);

} // namespace relume
