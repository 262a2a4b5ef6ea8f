#include "precompute/brdf/merl.h"

#include "engine/base/error.h"
#include "engine/base/log.h"
#include "precompute/brdf/table_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr std::array<int32_t, 3> kCells = {90, 90, 180};
constexpr size_t kCellCount = 90 * 90 * 180;
constexpr size_t kFileSize = sizeof(kCells) + 3 * kCellCount * sizeof(double);
constexpr std::array<double, 3> kScales = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr double kMaxValue = 1e6; // sr⁻¹, far above any surface

// Reads all values; a negative one in any channel makes its cell missing.
std::vector<bool> readValues(std::span<const std::byte> bytes, const std::string& name,
                             IsotropicTable& table) {
    std::vector<bool> isMissing(kCellCount, false);
    for (size_t channel = 0; channel < 3; channel++)
        for (size_t cell = 0; cell < kCellCount; cell++) {
            const size_t index = channel * kCellCount + cell;
            double value;
            std::memcpy(&value, bytes.data() + sizeof(kCells) + index * sizeof(double), sizeof(double));
            value *= kScales[channel];
            if (!(std::abs(value) <= kMaxValue))
                throw Error(
                    fmt::format("{}: value {} is {} sr^-1: expected numbers up to {}; is the file damaged?",
                                name, index, value, kMaxValue));
            if (value < 0) isMissing[cell] = true;
            table[cell][int(channel)] = float(value);
        }
    return isMissing;
}

std::vector<bool> cellsBelowHorizon(const IsotropicTable& table) {
    std::vector<bool> isBelow(kCellCount);
    for (int half = 0; half < table.halves(); half++)
        for (int difference = 0; difference < table.differences(); difference++)
            for (int azimuth = 0; azimuth < table.azimuths(); azimuth++) {
                const auto [wi, wo] = directionsOf(table.centerOf(half, difference, azimuth));
                isBelow[table.cell(half, difference, azimuth)] = std::min(wi.z, wo.z) <= 0;
            }
    return isBelow;
}

} // namespace

bool looksLikeMerl(std::span<const std::byte> bytes) {
    return bytes.size() >= sizeof(kCells) && std::memcmp(bytes.data(), kCells.data(), sizeof(kCells)) == 0;
}

IsotropicTable parseMerl(std::span<const std::byte> bytes, const std::string& name) {
    if (!looksLikeMerl(bytes))
        throw Error(
            fmt::format("{}: not a MERL file: it does not begin with the sizes 90, 90, 180 in binary", name));
    if (bytes.size() != kFileSize)
        throw Error(fmt::format("{}: a MERL file has {} bytes, this one has {}; is it cut short?", name,
                                kFileSize, bytes.size()));
    IsotropicTable table(kCells[0], kCells[1], kCells[2]);
    std::vector<bool> isMissing = readValues(bytes, name, table);
    const std::vector<bool> isBelow = cellsBelowHorizon(table);
    size_t negative = 0, negativeAbove = 0, above = 0;
    for (size_t cell = 0; cell < kCellCount; cell++) {
        negative += isMissing[cell];
        above += !isBelow[cell];
        negativeAbove += isMissing[cell] && !isBelow[cell];
        isMissing[cell] = isMissing[cell] || isBelow[cell];
    }
    if (negativeAbove == above)
        throw Error(fmt::format(
            "{}: every value above the horizon is negative (not measured); nothing to use", name));
    fillMissing(table, std::move(isMissing));
    const GrazingRepair grazing = limitGrazing(table);
    const auto percent = [](size_t part, size_t whole) { return 100 * double(part) / double(whole); };
    log(LogLevel::Info,
        fmt::format(
            "{}: {} of {} cells are negative ({:.2f} %), {} of them above the horizon ({:.2f} %); filled "
            "from their neighbors",
            name, negative, kCellCount, percent(negative, kCellCount), negativeAbove,
            percent(negativeAbove, above)));
    log(LogLevel::Info,
        fmt::format("{}: {} of {} cells beyond 80 degrees were lowered ({:.2f} %)", name, grazing.lowered,
                    grazing.cells, percent(grazing.lowered, std::max(grazing.cells, size_t(1)))));
    return table;
}

} // namespace relume
