// Readers of measured BRDFs, in three targets. An input of `brdf` is, by its first byte, the text of a
// Cornell file or a MERL file, which is then too short. `cornell` makes such a text into a table. An input of
// `merl` is edits of the values of a whole file. The last two take milliseconds for any input.
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "precompute/brdf/cornell.h"
#include "precompute/brdf/cornell_text.h"
#include "precompute/brdf/merl.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/fuzz_edits.h"

#include <cmath>

namespace relume::test {

namespace {

void checkTable(const IsotropicTable& table) {
    for (size_t cell = 0; cell < table.cellCount(); cell++)
        for (int c = 0; c < 3; c++) RELUME_CHECK(std::isfinite(table[cell][c]) && table[cell][c] >= 0);
}

void run(std::span<const std::byte> input) {
    if (input.empty()) return;
    const auto rest = input.subspan(1);
    try {
        if (int(input[0]) % 2 == 0) {
            for (const CornellSample& sample : readCornellText(textOf(rest), "input").samples)
                for (const float value : sample.values) RELUME_CHECK(std::isfinite(value));
        } else {
            parseMerl(rest, "input");
        }
    } catch (const Error&) {
    }
}

void runCornell(std::span<const std::byte> input) {
    try {
        checkTable(parseCornell(textOf(input), "input"));
    } catch (const Error&) {
    }
}

std::string cornellText() {
    std::string text = "# a comment\n5\n400 450 500\n600 700\n";
    for (int i = 0; i < 17; i++)
        text += fmt::format("{} 0 {} -1.5 0.1 0.2 {} 0.1 0.05\n", 0.08 * i, 0.05 * i, 0.01 * i);
    return text;
}

std::vector<Bytes> seeds() {
    const std::string merl("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12);
    return {seedOf({0}, cornellText()), seedOf({1}, merl)};
}

std::vector<Bytes> cornellSeeds() { return {seedOf({}, cornellText())}; }

const AddFuzzTarget kAdded({"brdf", run, seeds}),
    kAddedCornell({"cornell", runCornell, cornellSeeds, uint64_t(64) << 20, 64, 20});

constexpr size_t kMerlBytes = 12 + 3 * 1458000 * sizeof(double);

// Edits of a MERL file of even gray: each is a cell's number (4 bytes), how many cells (2 bytes), and the
// upper two bytes of the value that they have.
void runMerl(std::span<const std::byte> input) {
    static Bytes file = [] {
        Bytes bytes(kMerlBytes);
        for (size_t i = 0; i < 3; i++) poke(bytes, 4 * i, i < 2 ? 90 : 180, 4);
        for (size_t i = 14 + 4; i < kMerlBytes; i += 8) poke(bytes, i, 0x4059, 2); // 100
        return bytes;
    }();
    std::vector<std::pair<size_t, uint16_t>> undo;
    for (ByteReader in(input, "edits"); in.left() >= 8;) {
        const size_t first = in.get<uint32_t>() % (3 * 1458000), count = in.get<uint16_t>();
        const auto value = in.get<uint16_t>();
        for (size_t i = first; i < std::min<size_t>(first + count, 3 * 1458000); i++) {
            const size_t offset = 12 + 8 * i + 6;
            undo.push_back({offset, ByteReader(std::span(file).subspan(offset), "").get<uint16_t>()});
            poke(file, offset, value, 2);
        }
    }
    try {
        checkTable(parseMerl(file, "input"));
    } catch (const Error&) {
    }
    for (size_t i = undo.size(); i-- > 0;) poke(file, undo[i].first, undo[i].second, 2);
}

std::vector<Bytes> merlSeeds() {
    return {seedOf({}, std::string("\x10\x27\0\0\x10\0\x40\xc0\x20\x27\0\0\x10\0\xff\x7f", 16))};
}

const AddFuzzTarget kAddedMerl({"merl", runMerl, merlSeeds, uint64_t(128) << 20, 64 << 10, 1});

} // namespace
} // namespace relume::test
