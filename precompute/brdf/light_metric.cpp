#include "precompute/brdf/light_metric.h"

#include "engine/base/check.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

using Eigen::MatrixXf;
using Eigen::VectorXf;

namespace {

constexpr int kDegrees = 30; // of the power law; finer detail counts as white
constexpr double kExponent = -1.5;
constexpr double kWhite = 0.02;
constexpr int kKernelSamples = 4096; // of the cosine; linear interpolation between them

// Returns E[L(ω) L(ω')] without the white part as a function of ω·ω': Σ (2l + 1) / 4π · power(l) ·
// Legendre_l.
std::vector<float> autocorrelation() {
    std::vector<float> kernel(kKernelSamples + 1);
    for (int i = 0; i <= kKernelSamples; i++) {
        const double x = 2.0 * i / kKernelSamples - 1;
        double sum = 0, legendre = 1, previous = 0;
        for (int l = 0; l <= kDegrees; l++) {
            sum += (2 * l + 1) / (4 * double(kPi)) * std::pow(1.0 + l, kExponent) * legendre;
            const double next = ((2 * l + 1) * x * legendre - l * previous) / (l + 1);
            previous = legendre;
            legendre = next;
        }
        kernel[size_t(i)] = float(sum);
    }
    return kernel;
}

float lookup(const std::vector<float>& kernel, float cosine) {
    const float place = std::clamp((cosine + 1) / 2, 0.0f, 1.0f) * float(kKernelSamples);
    const int low = std::min(int(place), kKernelSamples - 1);
    return std::lerp(kernel[size_t(low)], kernel[size_t(low) + 1], place - float(low));
}

} // namespace

MatrixXf lightMetric(const BrdfTable& table) {
    const auto n = Eigen::Index(table.directions.size());
    const std::vector<float> kernel = autocorrelation();
    MatrixXf correlation(n, n);
    tbb::parallel_for(Eigen::Index(0), n, [&](Eigen::Index j) {
        const vec3 direction = table.directions[size_t(j)];
        for (Eigen::Index i = j; i < n; i++)
            correlation(i, j) = lookup(kernel, glm::dot(table.directions[size_t(i)], direction));
        correlation(j, j) += float(kWhite) / table.solidAngles[size_t(j)];
    });
    const Eigen::LLT<Eigen::Ref<MatrixXf>> cholesky(correlation); // in place, in the lower half
    RELUME_CHECK_EQ(int(cholesky.info()), int(Eigen::Success));   // the white part keeps it positive definite
    MatrixXf metric = cholesky.matrixU();
    for (Eigen::Index i = 0; i < n; i++)
        metric.col(i) *= table.directions[size_t(i)].z * table.solidAngles[size_t(i)];
    return metric;
}

VectorXf viewMetric(const BrdfTable& table) {
    VectorXf weights(Eigen::Index(table.directions.size()));
    for (size_t i = 0; i < table.directions.size(); i++)
        weights[Eigen::Index(i)] = std::sqrt(table.directions[i].z * table.solidAngles[i]);
    return weights;
}

} // namespace relume
