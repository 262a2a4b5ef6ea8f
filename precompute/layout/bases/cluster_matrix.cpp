#include "precompute/layout/bases/cluster_matrix.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace relume {

namespace {

constexpr double kLeastEnergy = 1e-7; // of a direction, relative to the term's

// Returns Σ g gᵀ over a light map's texels g, weighted by squared cosine and solid angle.
Eigen::Matrix3d covariance(const FactoredBrdf& brdf, const vec3* map) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int y = 0; y < brdf.size; y++)
        for (int x = 0; x < brdf.size; x++) {
            const vec2 place = (vec2(x, y) + 0.5f) / float(brdf.size);
            const std::optional<vec3> direction = diskMapDirection(brdf.mapping, place);
            if (!direction) continue;
            const vec3 texel = map[y * brdf.size + x];
            const Eigen::Vector3d g(texel.x, texel.y, texel.z);
            const double weight =
                double(direction->z) * direction->z * double(diskMapSolidAngle(brdf.mapping, place));
            sum += weight * g * g.transpose();
        }
    return sum;
}

bool isGray(const FactoredBrdf& brdf, const vec3* map) {
    return std::all_of(map, map + brdf.mapTexels(), [](vec3 g) { return g.x == g.y && g.y == g.z; });
}

// Calls entry(row of the matrix, kind, coefficient, value) for all entries of a cluster.
template <typename Entry>
void forEachEntry(const SparseTransport& rows, uint32_t first, uint32_t count,
                  std::span<const BasisKind> kinds, std::span<const float> spectrum, float norm,
                  const Entry& entry) {
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        const vec3 dual = kindDual(kinds[kind]) * glm::length(kinds[kind].color);
        for (uint32_t vertex = 0; vertex < count; vertex++) {
            const size_t row = (size_t(first) + vertex) * rows.terms + kinds[kind].term;
            const vec3 scale = dual * (rows.scales[row] / norm) * kCoefficientUnit;
            for (uint64_t i = rows.rowStarts[row]; i < rows.rowStarts[row + 1]; i++)
                entry(kind * count + vertex, kind, rows.indices[i],
                      glm::dot(scale, vec3(unpackCoefficient(rows.values[i]))) * spectrum[rows.indices[i]]);
        }
    }
}

} // namespace

std::vector<BasisKind> basisKinds(const FactoredBrdf& brdf, bool isBounced) {
    std::vector<BasisKind> kinds;
    for (int term = 0; term < brdf.terms; term++) {
        const vec3* map = brdf.lightMap(term);
        if (isGray(brdf, map)) {
            kinds.push_back({uint32_t(term), vec3(1)});
            if (isBounced) {
                kinds.push_back({uint32_t(term), {1, 0, -1}});
                kinds.push_back({uint32_t(term), {1, -2, 1}});
            }
            continue;
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance(brdf, map));
        const double most = solver.eigenvalues().sum() * kLeastEnergy;
        for (int i = 2; i >= 0; i--) {
            if (i < 2 && !isBounced && solver.eigenvalues()[i] <= most) break;
            Eigen::Vector3d color = solver.eigenvectors().col(i);
            if (color.sum() < 0) color = -color;
            kinds.push_back({uint32_t(term), vec3(color.x(), color.y(), color.z())});
        }
    }
    return kinds;
}

ClusterMatrix clusterMatrix(const SparseTransport& rows, uint32_t first, uint32_t count,
                            std::span<const BasisKind> kinds, std::span<const float> spectrum, float norm) {
    ClusterMatrix matrix;
    matrix.vertices = count;
    matrix.norm = norm;
    if (rows.terms == 1) matrix.importance = kDiffuseImportance;
    matrix.energy.setZero(Eigen::Index(kinds.size()));
    std::vector<double> energy(spectrum.size(), 0.0);
    forEachEntry(rows, first, count, kinds, spectrum, norm,
                 [&](size_t, size_t kind, uint16_t column, float value) {
                     const double square = double(value) * value;
                     matrix.energy[Eigen::Index(kind)] += square;
                     energy[column] += square;
                 });

    for (size_t column = 0; column < energy.size(); column++)
        if (energy[column] > 0) matrix.columns.push_back(uint16_t(column));
    const bool isNarrow = kinds.size() <= kFewKinds || kinds.size() * count <= kAnalyzedSide;
    const size_t least = isNarrow ? kMostBasisColumns : kAnalyzedSide,
                 most = isNarrow ? kMostBasisColumns : kMostAnalyzedColumns;
    if (matrix.columns.size() > least) {
        std::ranges::sort(matrix.columns, [&](uint16_t a, uint16_t b) {
            return energy[a] != energy[b] ? energy[a] > energy[b] : a < b;
        });
        double leftOut = 0;
        for (size_t i = least; i < matrix.columns.size(); i++) leftOut += energy[matrix.columns[i]];
        size_t kept = least;
        while (kept < std::min(most, matrix.columns.size()) && leftOut > kMostLeftOut * count)
            leftOut -= energy[matrix.columns[kept++]];
        matrix.columns.resize(kept);
        std::ranges::sort(matrix.columns);
    }

    std::vector<int> places(spectrum.size(), -1);
    for (size_t i = 0; i < matrix.columns.size(); i++) places[matrix.columns[i]] = int(i);
    matrix.values.setZero(Eigen::Index(kinds.size() * count), Eigen::Index(matrix.columns.size()));
    forEachEntry(rows, first, count, kinds, spectrum, norm,
                 [&](size_t row, size_t, uint16_t column, float value) {
                     if (places[column] >= 0) matrix.values(Eigen::Index(row), places[column]) = value;
                 });
    return matrix;
}

} // namespace relume
