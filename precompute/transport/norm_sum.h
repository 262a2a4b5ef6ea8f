// The normalization of a set's transport, to which its errors are relative.
#pragma once

#include "engine/transport/rows/sparse_transport.h"

#include <span>

namespace relume {

// Returns the RMS distance of a set's vertices from their mean, over all terms and weighted by the spectrum,
// or a tenth of the RMS of their transport if that is more; 1 if there is none. Errors are thus relative to
// what distinguishes vertices: a dark part is not starved beside a bright one, nor a shadow on an otherwise
// even ground.
float transportNorm(const SparseTransport& rows, std::span<const float> spectrum);

// Computes the same for vertices that come a few at a time.
class NormSum {
  public:
    // Keeps a reference to `spectrum`, a weight per coefficient.
    NormSum(uint32_t terms, std::span<const float> spectrum);

    void add(const SparseTransport& rows); // with the same number of terms

    // Returns the normalization of all vertices so far.
    float norm() const;

    // Returns their normalization where bounced light was added to `direct`: that of the direct transport,
    // times the growth of its RMS, but at least norm() and hardly more. Bounced light fills shadows, so that
    // vertices differ less while there is more light; relative to norm(), errors would be a smaller share of
    // the light than without it.
    float normBeside(const NormSum& direct) const;

  private:
    double rms() const; // of a vertex, over all terms

    std::span<const float> mSpectrum;
    uint32_t mTerms;
    uint64_t mVertices = 0;
    double mEnergy = 0;
    std::vector<glm::dvec3> mSums; // per term and coefficient
};

} // namespace relume
