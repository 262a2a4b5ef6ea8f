#include "precompute/brdf/tabulation.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

void listDirections(BrdfTable& table) {
    for (int y = 0; y < table.size; y++)
        for (int x = 0; x < table.size; x++) {
            const vec2 center = (vec2(float(x), float(y)) + 0.5f) / float(table.size);
            const auto direction = diskMapDirection(table.mapping, center);
            if (!direction) continue;
            table.texels.push_back({x, y});
            table.directions.push_back(*direction);
            table.solidAngles.push_back(diskMapSolidAngle(table.mapping, center) /
                                        float(table.size * table.size));
        }
}

// For a mean, points of two texels are paired by a rank-1 lattice (Roberts' R4), shifted randomly per pair of
// texels.
constexpr int kMeanSamples = 4;
constexpr glm::dvec4 kLattice(0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101);

// The finalizer of SplitMix64 (Steele, Lea and Flood 2014).
uint64_t mix(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

class Tabulator {
  public:
    Tabulator(const Brdf& brdf, BrdfPart part, TexelValue value, BrdfTable& table)
        : mBrdf(brdf), mPart(part), mValue(value), mTable(table) {}

    // Tabulates one outgoing direction; for a reciprocal BRDF, the values up to the diagonal and their mirror
    // images.
    void tabulateColumn(int outgoing) const {
        const bool mirrors = mBrdf.isReciprocal();
        const int end = mirrors ? outgoing + 1 : int(mTable.directions.size());
        for (int i = 0; i < end; i++) {
            const vec3 value = mValue == TexelValue::Mean ? mean(i, outgoing)
                                                          : evaluate(mTable.directions[size_t(i)],
                                                                     mTable.directions[size_t(outgoing)]);
            for (int c = 0; c < 3; c++) {
                RELUME_CHECK_LE(0.0f, value[c]); // fails for NaN, too
                RELUME_CHECK_LT(value[c], std::numeric_limits<float>::infinity());
                mTable.channels[size_t(c)](i, outgoing) = value[c];
                if (mirrors) mTable.channels[size_t(c)](outgoing, i) = value[c];
            }
        }
    }

  private:
    vec3 evaluate(vec3 incoming, vec3 outgoing) const {
        if (mPart == BrdfPart::Base) return mBrdf.evaluateBase(incoming, outgoing);
        const vec3 all = mBrdf.evaluate(incoming, outgoing);
        // Rounding must not make a difference negative.
        return mPart == BrdfPart::All ? all : glm::max(all - mBrdf.evaluateBase(incoming, outgoing), vec3(0));
    }

    vec3 mean(int incoming, int outgoing) const {
        // The points of a swapped pair of texels are swapped, so that nearly reciprocal BRDFs stay nearly
        // symmetric.
        const auto [first, second] = std::minmax(incoming, outgoing);
        const uint64_t bits = mix(uint64_t(first) << 32 | uint64_t(second));
        glm::dvec4 place(bits & 0xffff, bits >> 16 & 0xffff, bits >> 32 & 0xffff, bits >> 48);
        place /= 65536.0;
        glm::dvec3 sum(0);
        double weights = 0;
        for (int sample = 0; sample < kMeanSamples; sample++, place = glm::fract(place + kLattice)) {
            vec3 wi = directionIn(first, vec2(place.x, place.y)),
                 wo = directionIn(second, vec2(place.z, place.w));
            if (incoming != first) std::swap(wi, wo);
            const double weight = double(wi.z) * double(wo.z);
            sum += weight * glm::dvec3(evaluate(wi, wo));
            weights += weight;
        }
        return vec3(sum / weights);
    }

    // Returns the direction of a point in a texel's unit square; the texel center's if the point is outside
    // the disk or nearly grazing.
    vec3 directionIn(int texel, vec2 place) const {
        const auto direction = diskMapDirection(mTable.mapping, (vec2(mTable.texels[size_t(texel)]) + place) /
                                                                    float(mTable.size));
        return direction && direction->z > kGrazingCosine ? *direction : mTable.directions[size_t(texel)];
    }

    const Brdf& mBrdf;
    BrdfPart mPart;
    TexelValue mValue;
    BrdfTable& mTable;
};

// Returns ‖M - Mᵀ‖ / ‖M‖, summed in double precision column by column.
float asymmetryOf(const Eigen::MatrixXf& matrix) {
    double difference = 0, total = 0;
    for (Eigen::Index i = 0; i < matrix.cols(); i++) {
        difference += (matrix.col(i) - matrix.row(i).transpose()).cast<double>().squaredNorm();
        total += matrix.col(i).cast<double>().squaredNorm();
    }
    return total > 0 ? float(std::sqrt(difference / total)) : 0.0f;
}

} // namespace

BrdfTable tabulate(const Brdf& brdf, int size, DiskMapping mapping, TexelValue value, BrdfPart part) {
    if (size < kMinMapSize || size > kMaxMapSize)
        throw UsageError(fmt::format("a BRDF map of {} texels a side: choose from {} to {}", size,
                                     kMinMapSize, kMaxMapSize));
    BrdfTable table;
    table.size = size;
    table.mapping = mapping;
    table.isIsotropic = brdf.isIsotropic();
    listDirections(table);
    const int count = int(table.directions.size());
    for (Eigen::MatrixXf& channel : table.channels) channel.resize(count, count);
    const Tabulator tabulator(brdf, part, value, table);
    tbb::parallel_for(0, count, [&](int outgoing) { tabulator.tabulateColumn(outgoing); });
    for (const Eigen::MatrixXf& channel : table.channels)
        table.asymmetry = std::max(table.asymmetry, asymmetryOf(channel));
    return table;
}

std::vector<int> nearestDirections(const BrdfTable& table) {
    std::vector<int> nearest(size_t(table.size) * size_t(table.size));
    for (int y = 0; y < table.size; y++)
        for (int x = 0; x < table.size; x++) {
            int least = INT_MAX;
            for (size_t i = 0; i < table.texels.size() && least > 0; i++) {
                const ivec2 offset = table.texels[i] - ivec2(x, y);
                const int distance = offset.x * offset.x + offset.y * offset.y;
                if (distance >= least) continue;
                least = distance;
                nearest[size_t(y * table.size + x)] = int(i);
            }
        }
    return nearest;
}

} // namespace relume
