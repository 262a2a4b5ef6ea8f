#include "precompute/brdf/tabulation.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

void listDirections(BrdfTable& table) {
    for (int y = 0; y < table.size; y++)
        for (int x = 0; x < table.size; x++) {
            const vec2 centre = (vec2(float(x), float(y)) + 0.5f) / float(table.size);
            const auto direction = diskMapDirection(table.mapping, centre);
            if (!direction) continue;
            table.texels.push_back({x, y});
            table.directions.push_back(*direction);
        }
}

// Every value of one outgoing direction: a column, contiguous in Eigen's order.
void tabulateColumn(const Brdf& brdf, BrdfTable& table, int outgoing) {
    const vec3 wo = table.directions[size_t(outgoing)];
    for (int i = 0; i < int(table.directions.size()); i++) {
        const vec3 value = brdf.evaluate(table.directions[size_t(i)], wo);
        for (int c = 0; c < 3; c++) {
            RELUME_CHECK_LE(0.0f, value[c]); // fails for NaN too
            RELUME_CHECK_LT(value[c], std::numeric_limits<float>::infinity());
            table.channels[size_t(c)](i, outgoing) = value[c];
        }
    }
}

// ‖M - Mᵀ‖ / ‖M‖, summed in double precision column by column.
float asymmetryOf(const Eigen::MatrixXf& matrix) {
    double difference = 0, total = 0;
    for (Eigen::Index i = 0; i < matrix.cols(); i++) {
        difference += (matrix.col(i) - matrix.row(i).transpose()).cast<double>().squaredNorm();
        total += matrix.col(i).cast<double>().squaredNorm();
    }
    return total > 0 ? float(std::sqrt(difference / total)) : 0.0f;
}

} // namespace

BrdfTable tabulate(const Brdf& brdf, int size, DiskMapping mapping) {
    if (size < kMinMapSize || size > kMaxMapSize)
        throw UsageError("a BRDF map of {} texels a side: choose from {} to {}", size, kMinMapSize,
                         kMaxMapSize);
    BrdfTable table;
    table.size = size;
    table.mapping = mapping;
    listDirections(table);
    const int count = int(table.directions.size());
    for (Eigen::MatrixXf& channel : table.channels) channel.resize(count, count);
    tbb::parallel_for(0, count, [&](int outgoing) { tabulateColumn(brdf, table, outgoing); });
    for (const Eigen::MatrixXf& channel : table.channels)
        table.asymmetry = std::max(table.asymmetry, asymmetryOf(channel));
    return table;
}

} // namespace relume
