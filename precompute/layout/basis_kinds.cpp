#include "precompute/layout/basis_kinds.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace relume {

namespace {

constexpr double kLeastEnergy = 1e-7; // of a direction, of a term's

// Σ g gᵀ over a light map's texels g, times the cosine that transport has, per solid angle.
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

bool isGrey(const FactoredBrdf& brdf, const vec3* map) {
    return std::all_of(map, map + brdf.mapTexels(), [](vec3 g) { return g.x == g.y && g.y == g.z; });
}

} // namespace

std::vector<BasisKind> basisKinds(const FactoredBrdf& brdf) {
    std::vector<BasisKind> kinds;
    for (int term = 0; term < brdf.terms; term++) {
        const vec3* map = brdf.lightMap(term);
        if (isGrey(brdf, map)) {
            kinds.push_back({uint32_t(term), vec3(1)});
            continue;
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance(brdf, map));
        const double most = solver.eigenvalues().sum() * kLeastEnergy;
        for (int i = 2; i >= 0; i--) {
            if (i < 2 && solver.eigenvalues()[i] <= most) break;
            Eigen::Vector3d color = solver.eigenvectors().col(i);
            if (color.sum() < 0) color = -color;
            kinds.push_back({uint32_t(term), vec3(color.x(), color.y(), color.z())});
        }
    }
    return kinds;
}

} // namespace relume
