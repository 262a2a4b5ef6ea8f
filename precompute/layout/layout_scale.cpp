#include "precompute/layout/layout_scale.h"

#include "precompute/layout/layouts.h"

#include <Eigen/Core>
#include <mutex>

namespace relume {

void makeSumsDeterministic() {
    constexpr std::ptrdiff_t kFirstCache = 32 << 10, kSecondCache = 256 << 10, kThirdCache = 2 << 20; // bytes
    static std::once_flag once;
    std::call_once(once, [] { Eigen::setCpuCacheSizes(kFirstCache, kSecondCache, kThirdCache); });
}

LayoutScale findScale(std::span<const SetSample> samples, int faceSize, uint64_t vertices,
                      const LayoutOptions& options) {
    makeSumsDeterministic();
    LayoutScale scale;
    LayoutTarget target{{}, 0};
    double allRows = 0, toldRows = 0; // toldRows: of sets with samples
    for (const SetSample& sample : samples) {
        scale.norms.push_back(sample.norm);
        const double rows = double(sample.vertices) * sample.set->brdf.terms;
        allRows += rows;
        if (sample.sampledVertices() == 0) continue;
        toldRows += rows;
        target.error += *options.error * *options.error * double(sample.vertices);
    }
    const double share = allRows > 0 ? toldRows / allRows : 1;
    if (options.bytesPerVertex) target.bytes = share * *options.bytesPerVertex * double(vertices);
    scale.lambda =
        std::visit([&](const auto& layout) { return findLambda(layout, samples, faceSize, target); },
                   emptyTransport(options.layout, 0, 0));
    return scale;
}

double defaultLayoutError(const Asset& asset) {
    for (const AssetPart& part : asset.parts)
        for (const MaterialSet& set : part.sets)
            if (set.brdf.terms > 1) return kDefaultLayoutError;
    return kDiffuseLayoutError;
}

LayoutRecord recordOf(const LayoutOptions& options, double error) {
    LayoutRecord record;
    record.wantedBytes = options.bytesPerVertex;
    if (!options.bytesPerVertex) record.wantedError = options.error;
    record.error = error;
    return record;
}

} // namespace relume
