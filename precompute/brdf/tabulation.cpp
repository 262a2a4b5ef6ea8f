#include "precompute/brdf/tabulation.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <limits>
#include <span>
#include <tbb/parallel_for.h>
#include <tuple>
#include <utility>

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

// Maps the number of every direction to that of its image.
using Permutation = std::vector<int>;

// Returns the quarter turns of an orthographic or equal-area map, the identity first. An isotropic BRDF has
// the same value for a pair of directions and for its images. Reflections would not do: measured BRDFs need
// not be the same in a mirror. Polar maps have other turns, which are not used.
std::vector<Permutation> quarterTurns(const BrdfTable& table) {
    const int size = table.size, count = int(table.directions.size());
    std::vector<int> numbers(size_t(size) * size_t(size), -1); // by texel
    for (int i = 0; i < count; i++) {
        const ivec2 texel = table.texels[size_t(i)];
        numbers[size_t(texel.y * size + texel.x)] = i;
    }
    std::vector<Permutation> turns;
    const int most = isPolar(table.mapping) ? 1 : 4;
    for (int turn = 0; turn < most; turn++) {
        Permutation& images = turns.emplace_back();
        for (ivec2 texel : table.texels) {
            for (int i = 0; i < turn; i++) texel = {size - 1 - texel.y, texel.x};
            images.push_back(numbers[size_t(texel.y * size + texel.x)]);
        }
        // Rounding may put one of two opposite texels at the rim outside the disk. The turns that remain are
        // a group.
        if (std::ranges::count(images, -1) > 0) turns.pop_back();
    }
    return turns;
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
        : mBrdf(brdf), mPart(part), mValue(value), mTable(table), mTurns(quarterTurns(table)) {
        if (!brdf.isIsotropic()) mTurns.resize(1);
    }

    // Tabulates an outgoing direction and its images, unless it is the image of an earlier one. Without
    // turns, the values of a reciprocal BRDF up to the diagonal suffice for those beyond.
    void tabulateColumn(int outgoing) const {
        const auto image = [&](const Permutation& turn) { return turn[size_t(outgoing)]; };
        if (std::ranges::any_of(mTurns, [&](const auto& by) { return image(by) < outgoing; })) return;
        const bool isMirrored = mBrdf.isReciprocal() && mTurns.size() == 1;
        const int end = isMirrored ? outgoing + 1 : int(mTable.directions.size());
        for (int i = 0; i < end; i++) {
            const vec3 value = valueOf(i, outgoing);
            for (int c = 0; c < 3; c++) {
                RELUME_CHECK_LE(0.0f, value[c]); // fails for NaN, too
                RELUME_CHECK_LT(value[c], std::numeric_limits<float>::infinity());
                mTable.channels[size_t(c)](i, outgoing) = value[c];
                if (isMirrored) mTable.channels[size_t(c)](outgoing, i) = value[c];
            }
        }
        for (const Permutation& turn : std::span(mTurns).subspan(1))
            for (Eigen::MatrixXf& channel : mTable.channels)
                for (int i = 0; i < end; i++) channel(turn[size_t(i)], image(turn)) = channel(i, outgoing);
    }

  private:
    // Two directions, in rising order of their numbers. Light comes from the first, or if swapped from the
    // second.
    struct Pair {
        int first, second;
        bool isSwapped;
    };

    // Returns the pair's image of least numbers. It is evaluated for all images, so that they have the same
    // value and the table of a reciprocal BRDF is symmetric.
    Pair representative(int incoming, int outgoing) const {
        Pair least{std::numeric_limits<int>::max(), 0, false};
        for (const Permutation& turn : mTurns) {
            const int in = turn[size_t(incoming)], out = turn[size_t(outgoing)];
            const Pair image{std::min(in, out), std::max(in, out), in > out && !mBrdf.isReciprocal()};
            if (std::tie(image.first, image.second) < std::tie(least.first, least.second)) least = image;
        }
        return least;
    }

    vec3 valueOf(int incoming, int outgoing) const {
        const Pair pair = representative(incoming, outgoing);
        if (mValue == TexelValue::Mean) return mean(pair);
        return evaluate(mTable.directions[size_t(pair.first)], mTable.directions[size_t(pair.second)],
                        pair.isSwapped);
    }

    vec3 evaluate(vec3 first, vec3 second, bool isSwapped) const {
        const auto [incoming, outgoing] = isSwapped ? std::pair(second, first) : std::pair(first, second);
        if (mPart == BrdfPart::Base) return mBrdf.evaluateBase(incoming, outgoing);
        const vec3 all = mBrdf.evaluate(incoming, outgoing);
        // Rounding must not make a difference negative.
        return mPart == BrdfPart::All ? all : glm::max(all - mBrdf.evaluateBase(incoming, outgoing), vec3(0));
    }

    // Swapped pairs have the same points, so that nearly reciprocal BRDFs stay nearly symmetric.
    vec3 mean(const Pair& pair) const {
        const uint64_t bits = mix(uint64_t(pair.first) << 32 | uint64_t(pair.second));
        glm::dvec4 place(bits & 0xffff, bits >> 16 & 0xffff, bits >> 32 & 0xffff, bits >> 48);
        place /= 65536.0;
        glm::dvec3 sum(0);
        double weights = 0;
        for (int sample = 0; sample < kMeanSamples; sample++, place = glm::fract(place + kLattice)) {
            const vec3 first = directionIn(pair.first, vec2(place.x, place.y)),
                       second = directionIn(pair.second, vec2(place.z, place.w));
            const double weight = double(first.z) * double(second.z);
            sum += weight * glm::dvec3(evaluate(first, second, pair.isSwapped));
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
    std::vector<Permutation> mTurns; // the identity alone if the BRDF is not isotropic
};

// Returns ‖M - Mᵀ‖ / ‖M‖, summed in double precision, in tiles that fit into a cache.
float asymmetryOf(const Eigen::MatrixXf& matrix) {
    constexpr Eigen::Index kTile = 64;
    double difference = 0, total = 0;
    for (Eigen::Index column = 0; column < matrix.cols(); column += kTile)
        for (Eigen::Index row = 0; row < matrix.rows(); row += kTile) {
            const Eigen::Index rows = std::min(kTile, matrix.rows() - row),
                               columns = std::min(kTile, matrix.cols() - column);
            const Eigen::MatrixXf tile = matrix.block(row, column, rows, columns),
                                  mirrored = matrix.block(column, row, columns, rows).transpose();
            difference += (tile - mirrored).cast<double>().squaredNorm();
            total += tile.cast<double>().squaredNorm();
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
