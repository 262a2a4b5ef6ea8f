// A window that is used for hours: it takes no more memory, opens no more files, and ends with the image that
// it began with. RELUME_SOAK=1 (scripts/soak) uses it for some two hours.
#include "tests/support/viewer_session.h"

#include <algorithm>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

// The memory and files that a process holds at a moment. Resident memory includes freed memory that malloc
// keeps.
struct Held {
    double heapMegabytes;
    double residentMegabytes;
    size_t files;
};

// Reads the file that support/memory_log.cpp writes.
std::vector<Held> readHeld(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::vector<Held> held;
    double heapBytes = 0, residentBytes = 0;
    for (size_t files = 0; file >> heapBytes >> residentBytes >> files;)
        held.push_back({heapBytes / (1 << 20), residentBytes / (1 << 20), files});
    return held;
}

// One round: light, material, size, what is inspected and compared, and the bake itself, which is read again;
// then a pause, in seconds.
std::vector<json> oneRound(double pause) {
    const json first = {{"environment", "room.exr"}, {"lamps", json::array()}, {"rotation", 0},
                        {"material", "gold"},        {"compare", "off"},       {"inspect", "off"}};
    return {{{"set", {{"rotation", 120}, {"material", "clay"}}}},
            {{"frames", 2}},
            {{"resize", {400, 300}}},
            {{"frames", 2}},
            {{"set", {{"environment", "sky"}, {"inspect", "wireframe"}}}},
            {{"frames", 2}},
            {{"set", {{"inspect", "off"}, {"lamps", {{{"azimuth", 40}, {"elevation", 50}}}}}}},
            {{"drag", "left"}, {"from", {200, 130}}, {"by", {40, 0}}, {"over", 2}},
            {{"drag", "left"}, {"from", {240, 130}}, {"by", {-40, 0}}, {"over", 2}},
            {{"set", {{"compare", "split"}}}},
            {{"wait", {{"passes", 1}}}},
            {{"set", {{"compare", "off"}}}},
            {{"drop", {"ring.relume"}}},
            {{"wait", "settled"}},
            {{"resize", {kSessionWidth, kSessionHeight}}},
            {{"set", first}},
            {{"frames", 2}},
            {{"wait", "settled"}},
            {{"wait", pause}}};
}

// Returns the least that was held between two shares of the time.
Held leastOf(const std::vector<Held>& held, double from, double to) {
    const auto at = [&](double share) { return held.begin() + std::ptrdiff_t(share * double(held.size())); };
    Held least = *at(from);
    for (auto now = at(from); now != at(to); ++now)
        least = {std::min(least.heapMegabytes, now->heapMegabytes),
                 std::min(least.residentMegabytes, now->residentMegabytes),
                 std::min(least.files, now->files)};
    return least;
}

} // namespace

TEST_CASE("viewer drift: a window that is used for long holds no more, and shows what it showed") {
    ViewerSession session;
    const bool isSoak = std::getenv("RELUME_SOAK");
    const int rounds = isSoak ? 1300 : 3;
    json script = {{{"wait", "settled"}}};
    for (int round = 0; round < rounds; round++) {
        for (const json& step : oneRound(isSoak ? 3 : 0.5)) script.push_back(step);
        if (round == 0) script.push_back({{"screenshot", "first.exr"}});
    }
    script.push_back({{"screenshot", "last.exr"}});
    script.push_back({{"quit", true}});
    std::ofstream(session.path("script.json")) << script;
    // Without validation, whose layer keeps some megabytes for every load.
    const Outcome outcome = session.view("--script script.json ring.relume room.exr",
                                         "RELUME_MEMORY_LOG=memory.txt LD_PRELOAD='" RELUME_MEMORY_LOG "'");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    const std::vector<Held> held = readHeld(session.path("memory.txt"));
    REQUIRE_GT(held.size(), 10);
    const Held before = leastOf(held, 0.25, 0.6), after = leastOf(held, 0.65, 0.95);
    const auto growth = [](double from, double to) { return 100 * (to / from - 1); }; // percent
    MESSAGE(rounds << " rounds, " << double(held.size()) / 10 << " s: heap " << before.heapMegabytes
                   << " MB, then " << growth(before.heapMegabytes, after.heapMegabytes)
                   << " % more; resident " << before.residentMegabytes << " MB, then "
                   << growth(before.residentMegabytes, after.residentMegabytes) << " % more; " << before.files
                   << " open files");
    // The first rounds are not yet as all that follow.
    if (isSoak) CHECK_LE(after.heapMegabytes, 1.01 * before.heapMegabytes);
    CHECK_LE(after.files, before.files);
    CHECK(session.bytes("first.exr") == session.bytes("last.exr"));
}
