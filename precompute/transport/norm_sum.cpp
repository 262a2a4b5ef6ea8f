#include "precompute/transport/norm_sum.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>

namespace relume {

// Least variation that a norm assumes, relative to the total, for a set whose vertices are all alike; errors
// then stay far below visibility.
static constexpr double kLeastVariation = 0.1;
// Most that bounced light may raise a norm above the vertices' own variation; scenes need 1.03 to 1.15. Where
// direct light reaches few vertices and bounced light all of them, shadows would be lost otherwise.
static constexpr float kMostRaise = 1.25f;

NormSum::NormSum(uint32_t terms, std::span<const float> spectrum)
    : mSpectrum(spectrum), mTerms(terms), mSums(terms * spectrum.size(), glm::dvec3(0)) {}

void NormSum::add(const SparseTransport& rows) {
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

double NormSum::rms() const { return std::sqrt(mEnergy / double(std::max<uint64_t>(1, mVertices))); }

float NormSum::norm() const {
    const double vertices = double(std::max<uint64_t>(1, mVertices));
    double common = 0;
    for (const glm::dvec3& sum : mSums) common += glm::dot(sum, sum) / vertices;
    const double varying = std::max(mEnergy - common, kLeastVariation * kLeastVariation * mEnergy);
    const auto norm = float(std::sqrt(varying / vertices));
    return norm > 0 && std::isfinite(norm) ? norm : 1;
}

float NormSum::normBeside(const NormSum& direct) const {
    const auto grown = float(rms() / direct.rms()) * direct.norm();
    return std::isfinite(grown) ? std::clamp(grown, norm(), kMostRaise * norm()) : norm();
}

float transportNorm(const SparseTransport& rows, std::span<const float> spectrum) {
    NormSum sum(rows.terms, spectrum);
    sum.add(rows);
    return sum.norm();
}

} // namespace relume
