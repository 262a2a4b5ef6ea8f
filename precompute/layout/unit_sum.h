// transportUnit() of vertices that come a few at a time.
#pragma once

#include "engine/transport/sparse_transport.h"

#include <span>

namespace relume {

class UnitSum {
  public:
    // `spectrum`, a weight per coefficient, outlives it.
    UnitSum(uint32_t terms, std::span<const float> spectrum);

    void add(const SparseTransport& rows); // of as many terms

    // Of all vertices so far: transportUnit() (cluster_matrix.h).
    float unit() const;

  private:
    std::span<const float> mSpectrum;
    uint32_t mTerms;
    uint64_t mVertices = 0;
    double mEnergy = 0;
    std::vector<glm::dvec3> mSums; // per term and coefficient
};

} // namespace relume
