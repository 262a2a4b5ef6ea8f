// Transport, Haar, selection, quantization and compaction on the device against their CPU twins.
#include "engine/math/cubemap.h"
#include "engine/math/haar.h"
#include "engine/vk/upload.h"
#include "precompute/bake/transport_pass.h"
#include "precompute/twins/transport_twin.h"
#include "shaders/select_comp.h"
#include "tests/support/test_device.h"

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using namespace relume;

namespace {

// Smooth maps with both signs, different for every term.
FactoredBrdf makeMaps(int terms, int size, DiskMapping mapping) {
    FactoredBrdf brdf;
    brdf.size = size;
    brdf.terms = terms;
    brdf.mapping = mapping;
    for (int term = 0; term < terms; term++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                const vec2 at = (vec2(x, y) + 0.5f) / float(size);
                const float wave = std::sin(float(term + 1) * (3 * at.x + 5 * at.y));
                brdf.lightMaps.emplace_back(1 + wave, wave, at.x * wave);
            }
    brdf.viewMaps = brdf.lightMaps;
    brdf.eigenvalues.resize(size_t(terms), {1, 1, 1});
    return brdf;
}

// Random points, and for each a visibility cube with a disk of blocked texels whose rim has the cosine
// `free`, none below the horizon free.
struct Samples {
    std::vector<shared::BakePoint> points;
    std::vector<std::vector<uint8_t>> visibility;
    std::vector<uint32_t> bits;
};

Samples makeSamples(int count, int size, float free = 0.6f) {
    std::mt19937 random(7);
    std::normal_distribution<float> gauss;
    const auto direction = [&] { return glm::normalize(vec3(gauss(random), gauss(random), gauss(random))); };
    Samples samples;
    for (int i = 0; i < count; i++) {
        const vec3 normal = direction(), blocker = direction();
        // Every other frame follows from the normal.
        samples.points.push_back({vec3(0), normal, i % 2 ? tangentFrame(normal, direction()).s : vec3(0)});
        std::vector<uint8_t>& cube = samples.visibility.emplace_back();
        for (int texel = 0; texel < 6 * size * size; texel++) {
            const vec3 towards =
                cubeTexelDirection(texel / (size * size), texel % size, texel / size % size, size);
            cube.push_back(glm::dot(towards, normal) > 0 && glm::dot(towards, blocker) < free);
        }
        for (size_t word = 0; word < cube.size() / 32; word++) {
            uint32_t packed = 0;
            for (size_t bit = 0; bit < 32; bit++) packed |= uint32_t(cube[word * 32 + bit]) << bit;
            samples.bits.push_back(packed);
        }
    }
    return samples;
}

struct Case {
    int faceSize, visibilitySize, transportSamples, coefficients, terms;
    DiskMapping mapping = DiskMapping::Orthographic;
};

void checkCase(const vk::Device& device, const Case& c) {
    CAPTURE(c.faceSize);
    CAPTURE(c.visibilitySize);
    CAPTURE(c.transportSamples);
    CAPTURE(c.coefficients);
    BakeOptions options;
    options.faceSize = c.faceSize;
    options.visibilitySize = c.visibilitySize;
    options.transportSamples = c.transportSamples;
    options.coefficients = c.coefficients;
    const FactoredBrdf brdf = makeMaps(c.terms, 16, c.mapping);
    const Samples samples = makeSamples(3, c.visibilitySize);
    const auto points = vk::upload<shared::BakePoint>(device, samples.points, "points");
    const auto bits = vk::upload<uint32_t>(device, samples.bits, "bits");
    const TransportPass pass(device, brdf, options, 4);
    vk::Commands commands(device, "transport test");
    commands.begin();
    pass.record(commands, points, 3, bits);
    commands.submitAndWait();
    SparseTransport found;
    found.rowStarts = {0};
    std::vector<TransportLosses> rowLosses;
    pass.collect(3, found, rowLosses);
    TransportLosses losses;
    for (const TransportLosses& row : rowLosses) losses.add(row);

    const size_t count = 6 * size_t(c.faceSize) * size_t(c.faceSize);
    double dropped = 0, total = 0;
    for (size_t row = 0; row < 3 * size_t(c.terms); row++) {
        const size_t point = row / size_t(c.terms), term = row % size_t(c.terms);
        std::vector<vec3> expected = transportVector(
            samples.visibility[point], c.visibilitySize, c.faceSize, c.transportSamples, brdf, int(term),
            tangentFrame(samples.points[point].normal, samples.points[point].tangent));
        haarForwardFaces(expected, c.faceSize);
        const std::vector<uint16_t> selected = selectLargest(expected, c.coefficients);
        const PackedRow packed = packRow(expected, selected);
        CHECK(found.scales[row] == doctest::Approx(packed.scale).epsilon(1e-4));

        // The device's row, dense, against the exact coefficients: what it keeps is right to half a step and
        // rounding, and it keeps nothing much smaller than the smallest that the twin keeps.
        std::vector<vec3> dense(count, vec3(0));
        for (uint64_t e = found.rowStarts[row]; e < found.rowStarts[row + 1]; e++) {
            if (e > found.rowStarts[row]) REQUIRE_LT(found.indices[e - 1], found.indices[e]);
            dense[found.indices[e]] = vec3(unpackCoefficient(found.values[e])) *
                                      (found.scales[row] / vec3(kRedMaximum, kGreenMaximum, kBlueMaximum));
        }
        const float step = packed.scale / float(kBlueMaximum);
        float worst = 0;
        size_t differentlyKept = 0;
        std::vector<bool> kept(count, false);
        for (uint16_t index : packed.indices) kept[index] = true;
        for (size_t i = 0; i < count; i++) {
            differentlyKept += kept[i] != (dense[i] != vec3(0));
            if (kept[i] && dense[i] != vec3(0)) worst = std::max(worst, glm::length(dense[i] - expected[i]));
            total += glm::dot(expected[i], expected[i]);
        }
        for (size_t i = 0, next = 0; i < count; i++) {
            if (next < selected.size() && selected[next] == i)
                next++;
            else
                dropped += glm::dot(expected[i], expected[i]);
        }
        CHECK_LT(worst, step);
        // Rounding swaps neighbors in magnitude, and values at the edge of zero: a few of them.
        CHECK_LE(differentlyKept, 2 + packed.indices.size() / 50);
    }
    CHECK(losses.total == doctest::Approx(total).epsilon(1e-3));
    CHECK(losses.dropped == doctest::Approx(dropped).epsilon(2e-3));
}

} // namespace

TEST_CASE("transport pass: every size and sampling gives its CPU twin's rows") {
    const TestDevice device;
    for (const Case& c :
         {Case{64, 256, 1, 96, 2}, Case{64, 256, 4, 96, 1}, Case{64, 256, 16, 96, 1}, Case{64, 128, 4, 33, 1},
          Case{64, 64, 1, 1, 2}, Case{32, 256, 1, 300, 1}, Case{32, 128, 16, 96, 5},
          Case{32, 64, 4, 96, 1, DiskMapping::Polar}, Case{64, 128, 1, 96, 2, DiskMapping::Polar},
          Case{64, 128, 1, 96, 5, DiskMapping::EqualArea}, Case{32, 64, 1, 96, 32, DiskMapping::EqualArea}})
        checkCase(device, c);
}

TEST_CASE("transport pass: lossless selection keeps every coefficient that does not quantize to zero") {
    const TestDevice device;
    checkCase(device, {64, 128, 1, 6 * 64 * 64, 1});
    checkCase(device, {32, 64, 1, 6 * 32 * 32, 3});
}

namespace {

struct Rows {
    SparseTransport transport;
    TransportLosses losses;
};

// The rows of all samples, `batch` points a submission.
Rows bakeSamples(const vk::Device& device, const TransportPass& pass, const Samples& samples, size_t batch) {
    const size_t wordsPerPoint = samples.bits.size() / samples.points.size();
    vk::Commands commands(device, "transport test");
    Rows rows;
    rows.transport.rowStarts = {0};
    for (size_t first = 0; first < samples.points.size(); first += batch) {
        const size_t count = std::min(batch, samples.points.size() - first);
        const auto points =
            vk::upload<shared::BakePoint>(device, std::span(samples.points).subspan(first, count), "points");
        const auto bits = vk::upload<uint32_t>(
            device, std::span(samples.bits).subspan(first * wordsPerPoint, count * wordsPerPoint), "bits");
        commands.begin();
        pass.record(commands, points, uint32_t(count), bits);
        commands.submitAndWait();
        std::vector<TransportLosses> losses;
        pass.collect(uint32_t(count), rows.transport, losses);
        for (const TransportLosses& row : losses) rows.losses.add(row);
    }
    return rows;
}

void checkSame(const Rows& a, const Rows& b) {
    CHECK(a.transport.rowStarts == b.transport.rowStarts);
    CHECK(a.transport.scales == b.transport.scales);
    CHECK(a.transport.indices == b.transport.indices);
    CHECK(a.transport.values == b.transport.values);
    CHECK_EQ(a.losses.total, b.losses.total);
    CHECK_EQ(a.losses.dropped, b.losses.dropped);
    CHECK_EQ(a.losses.quantized, b.losses.quantized);
}

} // namespace

TEST_CASE("transport pass: more terms than fit one buffer take turns") {
    const TestDevice device;
    BakeOptions options;
    const FactoredBrdf brdf = makeMaps(32, 8, DiskMapping::Orthographic);
    // Enough capacity that 32 terms of it exceed the largest storage buffer on lavapipe (128 MiB).
    const uint32_t capacity = std::min(64u, TransportPass::largestBatch(device, options));
    const Samples samples = makeSamples(2, 256);
    const Rows apart = bakeSamples(device, {device, brdf, options, capacity}, samples, 2);
    CHECK_EQ(apart.transport.scales.size(), 64u);
    checkSame(apart, bakeSamples(device, {device, brdf, options, 2}, samples, 2));
}

TEST_CASE("transport pass: any tuning gives the same rows") {
    const TestDevice device;
    BakeOptions options;
    options.visibilitySize = 128;
    const FactoredBrdf brdf = makeMaps(3, 16, DiskMapping::EqualArea);
    const Samples samples = makeSamples(5, 128);
    const uint64_t pointBytes = 3 * PackingPass::coefficientBytes(options.faceSize);
    const auto bake = [&](const TransportTuning& tuning) {
        return bakeSamples(device, {device, brdf, options, 5, tuning}, samples, 5);
    };
    const Rows expected = bake({64, ~0ull});
    checkSame(bake({64, 2 * pointBytes}), expected); // 2, 2 and 1 point
    checkSame(bake({64, 0}), expected);
    Rows narrow = bake({8, ~0ull});
    CHECK(narrow.losses.dropped == doctest::Approx(expected.losses.dropped));
    CHECK(narrow.losses.total == doctest::Approx(expected.losses.total));
    narrow.losses = expected.losses; // but for rounding
    checkSame(narrow, expected);
}

TEST_CASE("transport pass: any batch gives the same rows, whatever an earlier one left behind") {
    const TestDevice device;
    BakeOptions options;
    options.visibilitySize = 128;
    const FactoredBrdf brdf = makeMaps(5, 16, DiskMapping::EqualArea);
    const Samples samples = makeSamples(5, 128), open = makeSamples(5, 128, 2),
                  shut = makeSamples(5, 128, -2);
    const Rows expected = bakeSamples(device, {device, brdf, options, 5}, samples, 5);
    const TransportPass pass(device, brdf, options, 5);
    bakeSamples(device, pass, open, 5);
    checkSame(bakeSamples(device, pass, samples, 2), expected);
    // Where nothing is visible there is nothing to keep.
    const Rows nothing = bakeSamples(device, pass, shut, 3);
    CHECK_EQ(nothing.transport.scales, std::vector<float>(25, 0.0f));
    CHECK(nothing.transport.values.empty());
    CHECK_EQ(nothing.losses.total, 0);
}

namespace {

// What select.comp reads of rows of coefficients: blocks of zeros are not written.
struct SelectInput {
    std::vector<vec3> slots;
    std::vector<vec2> summaries;
};
SelectInput makeSelectInput(const std::vector<std::vector<vec3>>& rows, size_t faceSize) {
    const size_t count = 6 * faceSize * faceSize;
    const size_t rowBlocks = 6 * (faceSize * faceSize / 16 + faceSize * faceSize / 256 + 1);
    SelectInput input;
    for (const std::vector<vec3>& row : rows) {
        std::vector<vec2> summaries(rowBlocks, vec2(0));
        std::vector<vec3> slots(16 * rowBlocks, vec3(std::numeric_limits<float>::quiet_NaN()));
        for (size_t i = 0; i < count; i++) {
            const float squared = row[i].x * row[i].x + row[i].y * row[i].y + row[i].z * row[i].z;
            vec2& summary = summaries[haarSlot(i, faceSize) / 16];
            summary = {std::max(summary.x, squared), summary.y + squared};
        }
        for (size_t i = 0; i < count; i++) {
            const size_t slot = haarSlot(i, faceSize);
            REQUIRE(std::isnan(slots[slot].x)); // its own
            if (summaries[slot / 16].x > 0) slots[slot] = row[i];
        }
        input.slots.insert(input.slots.end(), slots.begin(), slots.end());
        input.summaries.insert(input.summaries.end(), summaries.begin(), summaries.end());
    }
    return input;
}

void checkSelect(const vk::Device& device, uint32_t faceSize, uint32_t lanes) {
    const uint32_t count = 6 * faceSize * faceSize;
    CAPTURE(faceSize);
    CAPTURE(lanes);
    std::mt19937 random(11);
    std::vector<std::vector<vec3>> rows(7, std::vector<vec3>(count, vec3(0)));
    for (vec3& value : rows[0]) value = vec3(float(random() % 4), 0, 0);              // many ties, many zeros
    for (vec3& value : rows[1]) value = vec3(1);                                      // all equal
    for (uint32_t i = 0; i < 5; i++) rows[3][i * 1000 + 17] = vec3(0, 1e-3f, -1e-3f); // row 2: zeros; few
    for (vec3& value : rows[4]) value = vec3(std::ldexp(1.0f, -int(random() % 60)));  // all magnitudes
    for (vec3& value : rows[5]) value = vec3(float(random()), -float(random()), float(random()));
    for (uint32_t i = 0; i < count; i += 97) rows[6][i] = vec3(float(i % 7), 0, 1); // few in few blocks

    const vk::ComputeProgram select(device, select_comp_spirv, {faceSize, lanes}, "select");
    const SelectInput input = makeSelectInput(rows, faceSize);
    const auto coefficients = vk::upload<vec3>(device, input.slots, "coefficients");
    const auto summaries = vk::upload<vec2>(device, input.summaries, "summaries");
    for (const uint32_t kept : {1u, 7u, 96u, 256u, 257u, 384u, 3000u, count}) {
        CAPTURE(kept);
        const vk::Buffer selected(device, rows.size() * kept * 4, vk::BufferUse::Readback, "selected");
        const vk::Buffer counts(device, rows.size() * 4, vk::BufferUse::Readback, "counts");
        const vk::Buffer statistics(device, rows.size() * 12, vk::BufferUse::Readback, "statistics");
        vk::Commands commands(device, "select test");
        commands.begin();
        commands.dispatch(select, {coefficients, summaries, selected, counts, statistics},
                          shared::RowsPush{uint32_t(rows.size()), kept, 0},
                          {uint32_t(rows.size()) * select.groupSize()[0], 1, 1});
        commands.barrier(vk::Stage::Compute, vk::Stage::Host);
        commands.submitAndWait();
        for (size_t row = 0; row < rows.size(); row++) {
            CAPTURE(row);
            const std::vector<uint16_t> expected = selectLargest(rows[row], int(kept));
            const auto found = selected.map<uint32_t>().subspan(row * kept, counts.map<uint32_t>()[row]);
            CHECK(std::vector<uint16_t>(found.begin(), found.end()) == expected);
            double dropped = 0;
            for (size_t i = 0, next = 0; i < count; i++) {
                if (next < expected.size() && expected[next] == i)
                    next++;
                else
                    dropped += double(glm::dot(rows[row][i], rows[row][i]));
            }
            CHECK_LE(std::abs(double(statistics.map<shared::RowStatistics>()[row].dropped) - dropped),
                     1e-4 * dropped);
        }
    }
}

} // namespace

TEST_CASE("select: ties, zeros and few candidates as in selectLargest") {
    const TestDevice device;
    for (const uint32_t lanes : {4u, 8u, 64u}) {
        checkSelect(device, 32, lanes);
        checkSelect(device, 64, lanes);
    }
}
