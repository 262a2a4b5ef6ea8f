#include "precompute/twins/relight_twin.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

namespace relume {

namespace {

// Returns the light as one value per coefficient.
std::vector<ivec3> expand(const LightVector& light) {
    std::vector<ivec3> dense(size_t(kCubeFaces) * size_t(light.faceSize) * size_t(light.faceSize), ivec3(0));
    for (size_t i = 0; i < light.indices.size(); i++)
        dense[light.indices[i]] = ivec3(light.values[i][0], light.values[i][1], light.values[i][2]);
    return dense;
}

std::vector<vec3> tuplesOf(const SparseTransport& transport, const LightVector& light) {
    const std::vector<ivec3> sums = relightSums(transport, light);
    std::vector<vec3> tuples(sums.size());
    for (size_t row = 0; row < tuples.size(); row++)
        tuples[row] = vec3(sums[row]) * (light.scale * transport.scales[row]) * kCoefficientUnit;
    return tuples;
}

std::vector<vec3> tuplesOf(const BasisTransport& transport, const LightVector& light) {
    const std::vector<ivec3> dense = expand(light);
    std::vector<vec3> tuples(transport.rows(), vec3(0));
    for (size_t number = 0; number < transport.clusters.size(); number++) {
        const BasisCluster& cluster = transport.clusters[number];
        std::vector<vec3> projections;
        for (size_t i = 0; i < cluster.components; i++) {
            ivec3 sum(0);
            for (size_t column = 0; column < cluster.columns(); column++)
                sum += int(cluster.basis[column * cluster.components + i]) * dense[cluster.indices[column]];
            projections.push_back(vec3(sum) * light.scale);
        }
        size_t scale = 0, weight = 0; // where the next kind's begin
        for (size_t kind = 0; kind < transport.kinds.size(); kind++) {
            const auto& [term, color] = transport.kinds[kind];
            for (size_t v = 0; v < transport.verticesOf(number); v++) {
                vec3 sum(0);
                for (size_t i = 0; i < cluster.counts[kind]; i++)
                    sum += float(cluster.weights[weight++]) * (projections[i] * cluster.scales[scale + i]);
                tuples[(number * kBasisVertices + v) * transport.terms + term] += sum * color;
            }
            scale += cluster.counts[kind];
        }
    }
    return tuples;
}

} // namespace

std::vector<ivec3> relightSums(const SparseTransport& transport, const LightVector& light) {
    const std::vector<ivec3> dense = expand(light);
    std::vector<ivec3> sums(transport.rows(), ivec3(0));
    for (size_t row = 0; row < sums.size(); row++)
        for (uint64_t entry = transport.rowStarts[row]; entry < transport.rowStarts[row + 1]; entry++) {
            RELUME_CHECK_LT(transport.indices[entry], dense.size());
            sums[row] += unpackCoefficient(transport.values[entry]) * dense[transport.indices[entry]];
        }
    return sums;
}

std::vector<vec3> relight(const Transport& transport, const LightVector& light) {
    return std::visit([&](const auto& kept) { return tuplesOf(kept, light); }, transport);
}

} // namespace relume
