#include "apps/relume/relight_traffic.h"

#include <span>
#include <vector>

namespace relume {

namespace {

std::vector<bool> metBy(const LightVector& light) {
    std::vector<bool> met(kMaximumLightEntries, false);
    for (const uint16_t index : light.indices) met[index] = true;
    return met;
}

double bytesRead(const SparseTransport& transport, const std::vector<bool>&) {
    return double(6 * transport.entries() + 4 * transport.rows());
}

double bytesRead(const BasisTransport& transport, const std::vector<bool>& met) {
    double bytes = 0;
    for (const BasisCluster& cluster : transport.clusters) {
        bytes += double(2 * cluster.columns() + 4 * cluster.scales.size() + cluster.weights.size());
        for (const uint16_t index : cluster.indices) bytes += met[index] ? cluster.components : 0;
    }
    return bytes;
}

} // namespace

double relightBytes(const Transport& transport, const LightVector& light) {
    const std::vector<bool> met = metBy(light);
    const double tuples = double(verticesOf(transport)) * termsOf(transport) * sizeof(vec3);
    return tuples + std::visit([&](const auto& kept) { return bytesRead(kept, met); }, transport);
}

} // namespace relume
