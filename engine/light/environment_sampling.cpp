// Prepares a map for sampling. Every step conserves Σ radiance · solid angle; sums are in double precision.
#include "engine/base/check.h"
#include "engine/light/environment.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace relume {

namespace {

using dvec3 = glm::dvec3;

struct Map {
    int width, height;
    std::vector<dvec3> radiance;

    dvec3& at(int x, int y) { return radiance[size_t(y) * size_t(width) + size_t(x)]; }
    const dvec3& at(int x, int y) const { return radiance[size_t(y) * size_t(width) + size_t(x)]; }
};

// Returns the solid angle between the upper pole and a row's upper edge, over 2π.
double capAbove(int row, int height) {
    const double half = std::sin(glm::pi<double>() * row / height / 2);
    return 2 * half * half;
}

// Overlap of a target pixel with a source pixel along one axis.
struct Share {
    int source;
    double weight; // share of the target; a target's weights sum to 1
};

// Returns, per target interval [t, t + 1], the shares of the source's intervals. sourceEdge(i) and
// targetEdge(t) give the edges' positions in the same unit, monotonically.
template <typename SourceEdge, typename TargetEdge>
std::vector<std::vector<Share>> overlaps(int sourceSize, int targetSize, SourceEdge sourceEdge,
                                         TargetEdge targetEdge) {
    std::vector<std::vector<Share>> shares(static_cast<size_t>(targetSize));
    int source = 0;
    for (int t = 0; t < targetSize; t++) {
        const double low = targetEdge(t), high = targetEdge(t + 1);
        while (source > 0 && sourceEdge(source) > low) source--;
        for (; source < sourceSize && sourceEdge(source) < high; source++) {
            const double covered = std::min(high, sourceEdge(source + 1)) - std::max(low, sourceEdge(source));
            if (covered > 0) shares[size_t(t)].push_back({source, covered / (high - low)});
        }
    }
    return shares;
}

// Resamples by area averages: columns by width, rows by solid angle.
Map resample(const Environment& environment, int width, int height) {
    const auto columns = overlaps(
        environment.width, width, [&](int i) { return double(i) / environment.width; },
        [&](int i) { return double(i) / width; });
    const auto rows = overlaps(
        environment.height, height, [&](int i) { return capAbove(i, environment.height); },
        [&](int i) { return capAbove(i, height); });
    Map map{width, height, std::vector<dvec3>(size_t(width) * size_t(height), dvec3(0))};
    for (int y = 0; y < height; y++)
        for (const Share& row : rows[size_t(y)]) {
            const vec3* source = &environment.radiance[size_t(row.source) * size_t(environment.width)];
            for (int x = 0; x < width; x++)
                for (const Share& column : columns[size_t(x)])
                    map.at(x, y) += row.weight * column.weight * dvec3(source[column.source]);
        }
    return map;
}

// Replaces a row by its circular moving average over a window of `columns`, at most the width, centered on
// each pixel.
void blurRow(dvec3* row, int width, double columns) {
    if (columns <= 1) return;
    std::vector<dvec3> sums(size_t(2 * width) + 1, dvec3(0)); // prefix sums over two turns
    for (int x = 0; x < 2 * width; x++) sums[size_t(x) + 1] = sums[size_t(x)] + row[x % width];
    const auto sumBefore = [&](double x) {
        const int whole = std::min(int(x), 2 * width - 1);
        return glm::mix(sums[size_t(whole)], sums[size_t(whole) + 1], x - whole);
    };
    for (int x = 0; x < width; x++) {
        const double start = x + 0.5 - columns / 2 + (x + 0.5 < columns / 2 ? width : 0);
        row[x] = glm::max((sumBefore(start + columns) - sumBefore(start)) / columns, dvec3(0));
    }
}

// Averages the rows around a pole. A bilinear lookup overweights a single polar row by 8 %, three rows
// together by 0.9 %.
void levelPole(Map& map, bool upper) {
    const int rows = std::min(3, map.height / 2);
    if (rows == 0) return;
    dvec3 sum(0);
    for (int i = 0; i < rows; i++) {
        const double weight = capAbove(i + 1, map.height) - capAbove(i, map.height);
        for (int x = 0; x < map.width; x++) sum += weight * map.at(x, upper ? i : map.height - 1 - i);
    }
    const dvec3 mean = sum / (capAbove(rows, map.height) * map.width);
    for (int i = 0; i < rows; i++)
        for (int x = 0; x < map.width; x++) map.at(x, upper ? i : map.height - 1 - i) = mean;
}

} // namespace

Environment prepareForSampling(const Environment& environment, int maxWidth) {
    RELUME_CHECK(environment.width > 0 && environment.height > 0 && maxWidth > 0);
    RELUME_CHECK_EQ(environment.radiance.size(), size_t(environment.width) * size_t(environment.height));
    const int width = std::min(environment.width, maxWidth);
    const int height = std::max(1, int(std::lround(double(environment.height) * width / environment.width)));
    Map map = resample(environment, width, height);
    for (int y = 0; y < height; y++) {
        const double across = std::sin(glm::pi<double>() * (y + 0.5) / height);
        for (int pass = 0; pass < 2; pass++)
            blurRow(&map.at(0, y), width, std::min(1 / across, double(width)));
    }
    levelPole(map, true);
    levelPole(map, false);
    Environment prepared{width, height, {}};
    prepared.radiance.assign(map.radiance.begin(), map.radiance.end());
    return prepared;
}

} // namespace relume
