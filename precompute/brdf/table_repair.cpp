#include "precompute/brdf/table_repair.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relume {

namespace {

constexpr float kReliableCosine = 0.17364818f; // of 80 degrees
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
    // A layer is of cells that are missing beside some that are not. Each looks at the one before alone: a
    // file that lacks almost all may have hundreds.
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
        // Only now, so that a layer does not feed on itself.
        for (const size_t cell : layer) isMissing[cell] = false;
        next.clear();
        for (const size_t cell : layer) findMissing(cell, next);
    }
}

GrazingRepair limitGrazing(IsotropicTable& table) {
    GrazingRepair repair;
    // Per φd, of the last reliable cell: where a θh has none, that of the θh before.
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
