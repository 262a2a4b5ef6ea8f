#include "precompute/cpu/cpu_relighter.h"

#include "engine/base/check.h"
#include "engine/math/cubemap.h"

#include <array>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

// The light as one value per coefficient.
class DenseLight {
  public:
    explicit DenseLight(const LightVector& light)
        : mValues(size_t(kCubeFaces) * size_t(light.faceSize) * size_t(light.faceSize), ivec3(0)) {
        for (size_t i = 0; i < light.indices.size(); i++)
            mValues[light.indices[i]] = {light.values[i][0], light.values[i][1], light.values[i][2]};
    }

    const ivec3& operator[](size_t index) const { return mValues[index]; }

  private:
    std::vector<ivec3> mValues;
};

template <typename Work>
void forAll(size_t count, const Work& work) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count), [&](const tbb::blocked_range<size_t>& range) {
        for (size_t i = range.begin(); i < range.end(); i++) work(i);
    });
}

class CpuRowsRelighter : public CpuRelighter {
  public:
    explicit CpuRowsRelighter(const SparseTransport& transport) : mTransport(transport) {}

    void relight(const LightVector& light, std::span<vec3> tuples) const override {
        const DenseLight dense(light);
        forAll(mTransport.rows(), [&](size_t row) {
            ivec3 sum(0);
            for (uint64_t e = mTransport.rowStarts[row]; e < mTransport.rowStarts[row + 1]; e++)
                sum += unpackCoefficient(mTransport.values[e]) * dense[mTransport.indices[e]];
            tuples[row] = vec3(sum) * (light.scale * mTransport.scales[row]) * kCoefficientUnit;
        });
    }

  private:
    const SparseTransport& mTransport;
};

// Processes the vertices of a cluster side by side, which keeps the order of each sum.
class CpuBasesRelighter : public CpuRelighter {
  public:
    explicit CpuBasesRelighter(const BasisTransport& transport) : mTransport(transport) {
        for (size_t number = 0; number < transport.clusters.size(); number++) {
            const BasisCluster& cluster = transport.clusters[number];
            const size_t vertices = transport.verticesOf(number);
            std::vector<int8_t>& sideBySide = mWeights.emplace_back(cluster.scales.size() * kBasisVertices);
            size_t weight = 0, component = 0;
            for (const size_t count : cluster.counts) {
                for (size_t v = 0; v < vertices; v++)
                    for (size_t i = 0; i < count; i++)
                        sideBySide[(component + i) * kBasisVertices + v] = cluster.weights[weight++];
                component += count;
            }
        }
    }

    void relight(const LightVector& light, std::span<vec3> tuples) const override {
        const DenseLight dense(light);
        forAll(mTransport.clusters.size(), [&](size_t number) {
            const BasisCluster& cluster = mTransport.clusters[number];
            combine(number, project(cluster, dense, light.scale), tuples);
        });
    }

  private:
    static std::vector<vec3> project(const BasisCluster& cluster, const DenseLight& dense, float scale) {
        const size_t components = cluster.components;
        std::vector<int32_t> sums(3 * components, 0);
        for (size_t column = 0; column < cluster.columns(); column++) {
            const ivec3 value = dense[cluster.indices[column]];
            if (value == ivec3(0)) continue;
            const int8_t* basis = &cluster.basis[column * components];
            for (size_t channel = 0; channel < 3; channel++) {
                int32_t* sum = &sums[channel * components];
                for (size_t i = 0; i < components; i++) sum[i] += int32_t(basis[i]) * value[int(channel)];
            }
        }
        std::vector<vec3> projections(components);
        for (size_t i = 0; i < components; i++)
            projections[i] = vec3(ivec3(sums[i], sums[components + i], sums[2 * components + i])) * scale;
        return projections;
    }

    void combine(size_t number, const std::vector<vec3>& projections, std::span<vec3> tuples) const {
        using Lane = std::array<float, kBasisVertices>;
        const BasisCluster& cluster = mTransport.clusters[number];
        const size_t vertices = mTransport.verticesOf(number),
                     firstRow = number * kBasisVertices * mTransport.terms;
        for (size_t row = 0; row < vertices * mTransport.terms; row++) tuples[firstRow + row] = vec3(0);
        size_t component = 0;
        for (size_t kind = 0; kind < mTransport.kinds.size(); kind++) {
            std::array<Lane, 3> sums{};
            for (size_t i = 0; i < cluster.counts[kind]; i++, component++) {
                const vec3 projection = projections[i] * cluster.scales[component];
                const int8_t* weights = &mWeights[number][component * kBasisVertices];
                for (size_t v = 0; v < kBasisVertices; v++) {
                    const auto weight = float(weights[v]);
                    sums[0][v] += weight * projection.x;
                    sums[1][v] += weight * projection.y;
                    sums[2][v] += weight * projection.z;
                }
            }
            const auto& [term, color] = mTransport.kinds[kind];
            for (size_t v = 0; v < vertices; v++)
                tuples[firstRow + v * mTransport.terms + term] +=
                    vec3(sums[0][v], sums[1][v], sums[2][v]) * color;
        }
    }

    const BasisTransport& mTransport;
    std::vector<std::vector<int8_t>> mWeights; // per cluster: component after component
};

std::unique_ptr<CpuRelighter> make(const SparseTransport& transport) {
    return std::make_unique<CpuRowsRelighter>(transport);
}
std::unique_ptr<CpuRelighter> make(const BasisTransport& transport) {
    return std::make_unique<CpuBasesRelighter>(transport);
}

} // namespace

std::unique_ptr<CpuRelighter> makeCpuRelighter(const Transport& transport) {
    return std::visit([](const auto& kept) { return make(kept); }, transport);
}

} // namespace relume
