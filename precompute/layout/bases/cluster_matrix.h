// The transport of a cluster of vertices as a matrix, for compression. Its rows are amounts of "kinds":
// directions in color space along which the transport of a term lies.
#pragma once

#include "engine/scene/factored_brdf.h"
#include "engine/transport/bases/basis_transport.h"
#include "engine/transport/rows/sparse_transport.h"

#include <Eigen/Core>
#include <span>

namespace relume {

// Returns, per term, the principal color directions of its light map: orthogonal, by descending energy,
// without those that have less than 1e-7 of the term's; (1, 1, 1) alone for a gray map. With `isBounced`,
// returns all three directions, since bounced light has colors of its own.
std::vector<BasisKind> basisKinds(const FactoredBrdf& brdf, bool isBounced = false);

// The amount of a kind in coefficient `t` is dot(kindDual(kind), t).
inline vec3 kindDual(const BasisKind& kind) { return kind.color / glm::dot(kind.color, kind.color); }

// Values are amounts of kinds, times the length of their color, times the light's spectrum
// (light_spectrum.h), divided by `norm`, so that errors of the matrix are errors of relighting. Row kind ·
// vertices + v is that of vertex v.
struct ClusterMatrix {
    uint32_t vertices = 0;
    float norm = 1;                // transportNorm() of the set
    double importance = 1;         // weight of its squared error against bytes
    std::vector<uint16_t> columns; // coefficient indices, ascending: those of most energy
    Eigen::MatrixXf values;
    Eigen::VectorXd energy; // per kind, over all coefficients: sum of squares

    size_t kinds() const { return size_t(energy.size()); }
};

// A set of one term has at most this many kinds. A cluster of so few is analyzed with all columns and vectors
// that a file can have, which the sharp shadows on a ground need.
constexpr size_t kFewKinds = 3;

// The columns of a cluster with more kinds, which time grows with the square of: kAnalyzedSide, and up to
// kMostAnalyzedColumns while the squares of what is left out exceed kMostLeftOut per vertex. Clusters of
// coarse, curved meshes need them: left out of a knot of 12,000 vertices were 5.4 % (root mean square), which
// no number of components can win back.
constexpr size_t kAnalyzedSide = 512, kMostAnalyzedColumns = 1024;
constexpr double kMostLeftOut = 2.5e-4; // 1.6 %

// Weight of squared errors in sets of one term. These are diffuse, most often a ground, on which shadows are
// all that is seen and no highlight masks errors.
constexpr double kDiffuseImportance = 40;

// Returns the matrix of vertices [first, first + count) of a set's rows.
ClusterMatrix clusterMatrix(const SparseTransport& rows, uint32_t first, uint32_t count,
                            std::span<const BasisKind> kinds, std::span<const float> spectrum, float norm);

} // namespace relume
