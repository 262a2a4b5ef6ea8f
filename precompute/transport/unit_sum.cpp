#include "precompute/transport/unit_sum.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>

namespace relume {

// Of a set whose vertices are all alike, relative to what they hold: errors stay far below what is seen.
static constexpr double kLeastVariation = 0.1;

UnitSum::UnitSum(uint32_t terms, std::span<const float> spectrum)
    : mSpectrum(spectrum), mTerms(terms), mSums(terms * spectrum.size(), glm::dvec3(0)) {}

void UnitSum::add(const SparseTransport& rows) {
    RELUME_CHECK_EQ(rows.terms, mTerms);
    for (size_t row = 0; row < rows.rows(); row++)
        for (uint64_t i = rows.rowStarts[row]; i < rows.rowStarts[row + 1]; i++) {
            const glm::dvec3 value = vec3(unpackCoefficient(rows.values[i])) * kCoefficientUnit *
                                     (mSpectrum[rows.indices[i]] * rows.scales[row]);
            mEnergy += glm::dot(value, value);
            mSums[row % mTerms * mSpectrum.size() + rows.indices[i]] += value;
        }
    mVertices += rows.vertices;
}

float UnitSum::unit() const {
    const double vertices = double(std::max<uint64_t>(1, mVertices));
    double common = 0;
    for (const glm::dvec3& sum : mSums) common += glm::dot(sum, sum) / vertices;
    const double varying = std::max(mEnergy - common, kLeastVariation * kLeastVariation * mEnergy);
    const auto unit = float(std::sqrt(varying / vertices));
    return unit > 0 && std::isfinite(unit) ? unit : 1;
}

float transportUnit(const SparseTransport& rows, std::span<const float> spectrum) {
    UnitSum sum(rows.terms, spectrum);
    sum.add(rows);
    return sum.unit();
}

} // namespace relume
