#include "apps/relume/csr_relighter.h"

#include "engine/math/cubemap.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr int64_t kRowsTogether = 4096;

} // namespace

CsrRelighter::CsrRelighter(const SparseTransport& transport, int faceSize) {
    const auto rows = int64_t(transport.rows());
    for (int channel = 0; channel < 3; channel++) {
        Matrix& matrix = mChannels[size_t(channel)];
        matrix.resize(rows, kCubeFaces * faceSize * faceSize);
        matrix.reserve(int64_t(transport.entries()));
        for (int64_t row = 0; row < rows; row++) {
            matrix.startVec(row);
            const float unit = transport.scales[size_t(row)] * kCoefficientUnit[channel];
            for (uint64_t e = transport.rowStarts[size_t(row)]; e < transport.rowStarts[size_t(row) + 1]; e++)
                matrix.insertBack(row, transport.indices[e]) =
                    float(unpackCoefficient(transport.values[e])[channel]) * unit;
        }
        matrix.finalize();
    }
}

void CsrRelighter::relight(const LightVector& light, std::array<Eigen::VectorXf, 3>& tuples) const {
    std::array<Eigen::VectorXf, 3> dense;
    for (size_t channel = 0; channel < 3; channel++) {
        dense[channel] = Eigen::VectorXf::Zero(mChannels[channel].cols());
        for (size_t i = 0; i < light.indices.size(); i++)
            dense[channel][light.indices[i]] = light.scale * float(light.values[i][channel]);
        tuples[channel].resize(mChannels[channel].rows());
    }
    const int64_t rows = mChannels[0].rows(), blocks = (rows + kRowsTogether - 1) / kRowsTogether;
    tbb::parallel_for(int64_t(0), 3 * blocks, [&](int64_t i) {
        const auto channel = size_t(i / blocks);
        const int64_t first = i % blocks * kRowsTogether, count = std::min(kRowsTogether, rows - first);
        tuples[channel].segment(first, count).noalias() =
            mChannels[channel].middleRows(first, count) * dense[channel];
    });
}

} // namespace relume
