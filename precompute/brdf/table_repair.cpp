#include "precompute/brdf/table_repair.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {

namespace {

constexpr float kReliableCosine = 0.17364818f; // cosine of 80 degrees
constexpr float kFresnelRise = 2.6f;

// Calls visit(cell) for up to six neighbors.
template <typename Visit>
void forNeighbors(const IsotropicTable& table, size_t cell, const Visit& visit) {
    const int azimuths = table.azimuths(), differences = table.differences();
    const int azimuth = int(cell % size_t(azimuths)), row = int(cell / size_t(azimuths));
    const int half = row / differences, difference = row % differences;
    visit(table.cell(half, difference, (azimuth + 1) % azimuths));
    visit(table.cell(half, difference, (azimuth + azimuths - 1) % azimuths));
    if (difference > 0) visit(table.cell(half, difference - 1, azimuth));
    if (difference + 1 < differences) visit(table.cell(half, difference + 1, azimuth));
    if (half > 0) visit(table.cell(half - 1, difference, azimuth));
    if (half + 1 < table.halves()) visit(table.cell(half + 1, difference, azimuth));
}

} // namespace

void fillMissing(IsotropicTable& table, std::vector<bool> isMissing) {
    // A layer is the missing cells next to known ones. Each search looks only at the previous layer, since a
    // file that lacks most cells may have hundreds of layers.
    std::vector<size_t> layer, next;
    std::vector<bool> isFound(isMissing.size());
    const auto findMissing = [&](size_t cell, std::vector<size_t>& found) {
        forNeighbors(table, cell, [&](size_t neighbor) {
            if (!isMissing[neighbor] || isFound[neighbor]) return;
            isFound[neighbor] = true;
            found.push_back(neighbor);
        });
    };
    for (size_t cell = 0; cell < isMissing.size(); cell++)
        if (!isMissing[cell]) findMissing(cell, layer);
    for (; !layer.empty(); layer.swap(next)) {
        for (const size_t cell : layer) {
            vec3 sum(0);
            float count = 0;
            forNeighbors(table, cell, [&](size_t neighbor) {
                if (isMissing[neighbor]) return;
                sum += table[neighbor];
                count++;
            });
            table[cell] = sum / count;
        }
        // Update only now, so that a layer does not use its own values.
        for (const size_t cell : layer) isMissing[cell] = false;
        next.clear();
        for (const size_t cell : layer) findMissing(cell, next);
    }
}

GrazingRepair limitGrazing(IsotropicTable& table) {
    GrazingRepair repair;
    // Per φd, the last reliable cell's value times its larger cosine; kept for a θh that has no reliable
    // cell.
    std::vector<vec3> reliable(size_t(table.azimuths()), vec3(0));
    for (int half = 0; half < table.halves(); half++)
        for (int difference = 0; difference < table.differences(); difference++)
            for (int azimuth = 0; azimuth < table.azimuths(); azimuth++) {
                vec3& value = table[table.cell(half, difference, azimuth)];
                const auto [wi, wo] = directionsOf(table.centerOf(half, difference, azimuth));
                const float upper = std::max({wi.z, wo.z, 1e-3f}), lower = std::min(wi.z, wo.z);
                if (lower >= kReliableCosine) {
                    reliable[size_t(azimuth)] = value * upper;
                    continue;
                }
                const vec3 limited = glm::min(value, reliable[size_t(azimuth)] * (kFresnelRise / upper));
                if (lower > 0) {
                    repair.cells++;
                    if (limited != value) repair.lowered++;
                }
                value = limited;
            }
    return repair;
}

} // namespace relume
