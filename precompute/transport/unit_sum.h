// What errors of a set's transport are relative to.
#pragma once

#include "engine/transport/rows/sparse_transport.h"

#include <span>

namespace relume {

// Root mean square over a set's vertices of how far they are from their mean in all terms, times the
// spectrum; a tenth of what they hold at least; 1 for none. As the unit it makes errors relative to what
// tells vertices apart: a dark part is not starved beside a bright one, nor a shadow on a ground that is
// otherwise even.
float transportUnit(const SparseTransport& rows, std::span<const float> spectrum);

// The same of vertices that come a few at a time.
class UnitSum {
  public:
    // `spectrum`, a weight per coefficient, outlives it.
    UnitSum(uint32_t terms, std::span<const float> spectrum);

    void add(const SparseTransport& rows); // of as many terms

    // Of all vertices so far.
    float unit() const;

  private:
    std::span<const float> mSpectrum;
    uint32_t mTerms;
    uint64_t mVertices = 0;
    double mEnergy = 0;
    std::vector<glm::dvec3> mSums; // per term and coefficient
};

} // namespace relume
