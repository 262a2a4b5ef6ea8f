#include "precompute/error/error_budget.h"

#include <cmath>

namespace relume {

namespace {

glm::dvec3 change(const StageRadiance& stages, size_t from, size_t to) {
    return glm::dvec3(stages[from]) - glm::dvec3(stages[to]);
}

double square(glm::dvec3 v) { return glm::dot(v, v); }

} // namespace

ErrorBudget errorBudget(std::span<const StageRadiance> points) {
    ErrorBudget budget;
    if (points.empty()) return budget;
    double level = 0, total = 0;
    std::array<double, kErrorSources> squares{}, products{};
    for (const StageRadiance& stages : points) {
        const glm::dvec3 all = change(stages, 0, kErrorSources);
        level += square(glm::dvec3(stages[kErrorSources]));
        total += square(all);
        for (size_t source = 0; source < kErrorSources; source++) {
            const glm::dvec3 own = change(stages, source, source + 1);
            squares[source] += square(own);
            products[source] += glm::dot(own, all);
        }
    }
    const auto count = double(points.size());
    budget.level = std::sqrt(level / (3 * count));
    if (level == 0) return budget;
    budget.total = std::sqrt(total / level);
    double sum = 0, variance = 0;
    for (size_t source = 0; source < kErrorSources; source++) {
        budget.sources[source] = {std::sqrt(squares[source] / level),
                                  total > 0 ? products[source] / total : 0};
        sum += squares[source];
    }
    budget.rootSumSquares = std::sqrt(sum / level);
    // Variance of the ratio of two means, total² = mean D² / mean T², by the delta method; the root varies
    // half as much.
    for (const StageRadiance& stages : points) {
        const double residual = square(change(stages, 0, kErrorSources)) -
                                total / level * square(glm::dvec3(stages[kErrorSources]));
        variance += residual * residual;
    }
    if (total > 0) budget.uncertainty = std::sqrt(variance) / level / (2 * budget.total);
    return budget;
}

} // namespace relume
