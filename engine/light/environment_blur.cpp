// Blurs a map by heat diffusion on the sphere, in finite volumes, so that energy is conserved: what leaves a
// pixel enters its neighbors.
#include "engine/base/check.h"
#include "engine/light/environment.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace relume {

namespace {

using dvec3 = glm::dvec3;

// Implicit steps, alternating between columns and rows; with six the kernel is nearly a Gaussian.
constexpr int kSteps = 6;

// Solves -low[i] x[i-1] + (1 + low[i] + high[i]) x[i] - high[i] x[i+1] = values[i], low[0] = high[n-1] = 0.
// The elimination is done once for all right-hand sides.
class Tridiagonal {
  public:
    Tridiagonal(std::vector<double> low, const std::vector<double>& high)
        : mLow(std::move(low)), mFactor(high.size()), mInverse(high.size()) {
        for (size_t i = 0; i < high.size(); i++) {
            mInverse[i] = 1 / (1 + mLow[i] + high[i] - (i > 0 ? mLow[i] * mFactor[i - 1] : 0));
            mFactor[i] = high[i] * mInverse[i];
        }
    }
    // Solves for `lanes` interleaved right-hand sides.
    template <typename Value>
    void solve(Value* values, size_t lanes = 1) const {
        const size_t count = mFactor.size();
        for (size_t lane = 0; lane < lanes; lane++) values[lane] *= mInverse[0];
        for (size_t i = 1; i < count; i++)
            for (Value* value = values + i * lanes; value < values + (i + 1) * lanes; value++)
                *value = (*value + mLow[i] * *(value - lanes)) * mInverse[i];
        for (size_t i = count - 1; i-- > 0;)
            for (Value* value = values + i * lanes; value < values + (i + 1) * lanes; value++)
                *value += mFactor[i] * *(value + lanes);
    }

  private:
    std::vector<double> mLow, mFactor, mInverse;
};

// Solves the same system on a circle with uniform exchange, by the Sherman–Morrison formula: the exchange
// between last and first is taken out of the matrix and corrected for in the solution.
class Cyclic {
  public:
    Cyclic(size_t count, double exchange)
        : mExchange(exchange), mChain(chain(count, exchange)), mMend(count, 0.0) {
        // A = T + u uᵀ with u = √exchange (e₀ - eₙ).
        mMend.front() = 1;
        mMend.back() = -1;
        mChain.solve(mMend.data());
        mScale = mExchange / (1 + mExchange * (mMend.front() - mMend.back()));
    }
    void solve(dvec3* values) const {
        mChain.solve(values);
        const dvec3 across = mScale * (values[0] - values[mMend.size() - 1]);
        for (size_t i = 0; i < mMend.size(); i++) values[i] -= mMend[i] * across;
    }

  private:
    static Tridiagonal chain(size_t count, double exchange) {
        std::vector<double> low(count, exchange), high(count, exchange);
        low.front() = high.back() = 0;
        return {std::move(low), high};
    }
    double mExchange;
    Tridiagonal mChain;
    std::vector<double> mMend;
    double mScale;
};

} // namespace

Environment blur(const Environment& environment, float deviation) {
    const auto width = size_t(environment.width), height = size_t(environment.height);
    RELUME_CHECK(width > 1 && height > 0 && deviation >= 0);
    RELUME_CHECK_EQ(environment.radiance.size(), width * height);
    const double columnAngle = 2 * glm::pi<double>() / double(width),
                 rowAngle = glm::pi<double>() / double(height);
    // Duration of a step; the variance is twice the duration.
    const double time = 0.5 * double(deviation) * double(deviation) / kSteps;
    // Returns the radius of a circle of latitude.
    const auto across = [&](double row) { return std::sin(rowAngle * row); };
    // Exchange between neighboring pixels is their border's length over their distance and the pixel's solid
    // angle.
    std::vector<double> low(height), high(height);
    std::vector<Cyclic> rows;
    for (size_t y = 0; y < height; y++) {
        const double area = 2 * std::sin(rowAngle / 2) * across(double(y) + 0.5); // divided by columnAngle
        low[y] = y > 0 ? time * across(double(y)) / (rowAngle * area) : 0;
        high[y] = y + 1 < height ? time * across(double(y + 1)) / (rowAngle * area) : 0;
        rows.emplace_back(width,
                          time * rowAngle / (across(double(y) + 0.5) * columnAngle * columnAngle * area));
    }
    const Tridiagonal column(std::move(low), high);
    std::vector<dvec3> values(environment.radiance.begin(), environment.radiance.end());
    for (int step = 0; step < kSteps; step++) {
        column.solve(values.data(), width);
        for (size_t y = 0; y < height; y++) rows[y].solve(&values[y * width]);
    }
    Environment blurred{environment.width, environment.height, {}};
    for (const dvec3& value : values) blurred.radiance.emplace_back(glm::max(value, dvec3(0)));
    return blurred;
}

} // namespace relume
