#include "precompute/residual/irradiance_fit.h"

#include <Eigen/Cholesky>

namespace relume {

std::vector<vec3> irradianceWeights(const FactoredBrdf& factors) {
    // Equal steps of the squared sine sample directions in proportion to the cosine.
    constexpr int kAngles = 48, kAzimuths = 96;
    const int terms = factors.terms;
    std::vector<vec3> directions;
    for (int j = 0; j < kAngles; j++)
        for (int i = 0; i < kAzimuths; i++) {
            const float squared = (float(j) + 0.5f) / kAngles, sine = std::sqrt(squared);
            const float azimuth = 2 * kPi * (float(i) + 0.5f) / kAzimuths;
            directions.emplace_back(sine * std::cos(azimuth), sine * std::sin(azimuth),
                                    std::sqrt(1 - squared));
        }
    const auto count = Eigen::Index(directions.size());
    std::vector<vec3> result(size_t(terms), vec3(0));
    for (int channel = 0; channel < 3; channel++) {
        Eigen::MatrixXd maps(count, terms);
        for (Eigen::Index i = 0; i < count; i++) {
            const MapPlace place = placeInMap(factors.size, factors.mapping, directions[size_t(i)]);
            for (int term = 0; term < terms; term++)
                maps(i, term) = double(lookupMap(factors.lightMap(term), place)[channel]);
        }
        // Regularize, since terms may be linearly dependent and a channel may be black.
        Eigen::MatrixXd normal = maps.transpose() * maps;
        normal.diagonal().array() += 1e-9 * std::max(normal.trace(), 1e-30);
        const Eigen::VectorXd weights = normal.ldlt().solve(maps.transpose() * Eigen::VectorXd::Ones(count));
        for (int term = 0; term < terms; term++) result[size_t(term)][channel] = float(weights[term]);
    }
    return result;
}

} // namespace relume
