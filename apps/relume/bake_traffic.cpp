#include "apps/relume/bake_traffic.h"

namespace relume {

BakeTraffic::BakeTraffic(const BakeSample& sample, const BakeOptions& options, double raysPerVertex,
                         double trianglesPerVertex)
    : mRays(raysPerVertex), mTriangles(trianglesPerVertex),
      mTexels(6.0 * options.visibilitySize * options.visibilitySize),
      mCoefficients(sample.termsPerVertex() * 6 * options.faceSize * options.faceSize),
      mKept(sample.termsPerVertex() * options.coefficients) {}

std::optional<double> BakeTraffic::cpu(const std::string& stage) const {
    constexpr double kDirection = 12, kCoefficient = 12, kEntry = 6;
    if (stage == "visibility") return mRays * kDirection + mTexels / 8;
    if (stage == "transport") return mTexels / 8 + mCoefficients * kCoefficient;
    if (stage == "haar") return 2 * mCoefficients * kCoefficient;
    if (stage == "select and pack") return mKept * (kCoefficient + kEntry);
    return std::nullopt;
}

std::optional<double> BakeTraffic::device(const std::string& stage) const {
    constexpr double kTriangleIndices = 12, kCoefficient = 12, kIndex = 4, kValue = 4;
    const double blocks = mCoefficients / 15, summaries = blocks * 8, slots = blocks * 16 * kCoefficient;
    if (stage == "visibility draw") return mTexels + mTriangles * kTriangleIndices; // one byte per texel
    if (stage == "visibility pack") return 3 * mTexels + mTexels / 8;               // copied, then packed
    if (stage == "visibility trace") return mTexels / 8;
    if (stage == "transport")
        return mTexels / 8 + slots + blocks * kCoefficient + summaries; // averages twice
    if (stage == "select") return summaries + mKept * (kCoefficient + kIndex);
    if (stage == "quantize") return mKept * (kIndex + kCoefficient + kValue);
    if (stage == "compact") return mKept * 2 * (kIndex + kValue);
    return std::nullopt;
}

} // namespace relume
