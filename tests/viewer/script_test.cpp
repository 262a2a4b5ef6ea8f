// Sessions of relume-viewer, replayed on a display that is not there.
#include "engine/image/image_file.h"
#include "tests/support/display.h"
#include "tests/support/read_timings.h"
#include "tests/support/run_relume.h"

#include <cmath>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

// A folder with a small bake of two materials, and scripts.
class Session {
  public:
    Session() {
        const Outcome bake = runRelume(
            mFolder,
            "bake knot -m '{\"set\": [\"gold\", \"clay\"]}' --ground --ground-tessellation 8 -K 4 -N 24 "
            "--visibility-size 64 --face-size 32 --map-size 16 -q -o knot.relume");
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    }

    Outcome replay(const json& script, const std::string& arguments) {
        std::ofstream(mFolder.path() / "script.json") << script;
        return runProgram(mFolder, RELUME_VIEWER,
                          "--script script.json --validation core,sync --size 480x360 " + arguments,
                          mDisplay.environment() + " XDG_CACHE_HOME=" + path("cache").string() +
                              " XDG_STATE_HOME=" + path("state").string() + " LP_NUM_THREADS=0 timeout 300");
    }
    Outcome relume(const std::string& arguments) { return runRelume(mFolder, arguments); }
    std::filesystem::path path(const std::string& file) const { return mFolder.path() / file; }
    std::string bytes(const std::string& file) const { return contents(path(file)); }

  private:
    TemporaryFolder mFolder;
    Display mDisplay;
};

// What the viewer says draws the same image.
std::string renderCommand(const std::string& words) {
    const std::string mark = "the same: relume ";
    const size_t start = words.rfind(mark);
    REQUIRE_NE(start, std::string::npos);
    const size_t end = words.find('\n', start);
    return words.substr(start + mark.size(), end - start - mark.size());
}

// Big-endian, after the signature and the name of the first chunk.
std::pair<int, int> pngSize(const std::string& bytes) {
    REQUIRE_GE(bytes.size(), 24u);
    const auto word = [&](size_t at) {
        int value = 0;
        for (size_t i = 0; i < 4; i++) value = value << 8 | uint8_t(bytes[at + i]);
        return value;
    };
    return {word(16), word(20)};
}

bool isQuiet(const std::string& words) { return !says(words, "validation") && !says(words, "error"); }

} // namespace

TEST_CASE("viewer: a settled view has the bytes that `relume render` draws") {
    Session session;
    const Outcome outcome =
        session.replay({{{"wait", "settled"}},
                        {{"screenshot", "first.exr"}},
                        {{"drag", "left"}, {"from", {300, 200}}, {"by", {90, -40}}, {"over", 3}},
                        {{"drag", "shift+left"}, {"from", {300, 200}}, {"by", {-20, 15}}},
                        {{"wheel", 3}, {"at", {310, 150}}},
                        {{"drag", "shift+right"}, {"from", {300, 200}}, {"by", {60, 0}}, {"over", 2}},
                        {{"set", {{"material", "clay"}, {"threshold", 64}}}},
                        {{"frames", 2}},
                        {{"screenshot", "view.exr"}},
                        {{"screenshot", "window.png"}},
                        {{"resize", {400, 300}}},
                        {{"frames", 3}},
                        {{"screenshot", "small.exr"}},
                        {{"quit", true}}},
                       "knot.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    REQUIRE_EQ(session.relume(renderCommand(outcome.err)).exitCode, 0);
    CHECK(session.bytes("image.exr") == session.bytes("small.exr"));
    CHECK_EQ(readImage(session.path("small.exr")).image.width, 400);

    const std::string before = outcome.err.substr(0, outcome.err.find("view.exr is written"));
    REQUIRE_EQ(session.relume(renderCommand(before)).exitCode, 0);
    CHECK(session.bytes("image.exr") == session.bytes("view.exr"));
    CHECK(session.bytes("first.exr") != session.bytes("view.exr"));
    CHECK_EQ(pngSize(session.bytes("window.png")), std::pair(480, 360));
}

TEST_CASE("viewer: another material of the set is in the next frame, without relighting what need not be") {
    Session session;
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"frames", 3}},
                                            {{"screenshot", "before.exr"}},
                                            {{"key", "M"}}, // gold, as it was baked
                                            {{"key", "M"}},
                                            {{"screenshot", "after.exr"}},
                                            {{"quit", true}}},
                                           "knot.relume --timings times.json");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    CHECK(session.bytes("before.exr") != session.bytes("after.exr"));
    // Frames in which the view was drawn: the first, and that of the new material.
    const std::vector<ReadSpan> spans = readTraceEvents(json::parse(session.bytes("times.json")));
    std::vector<int> views, shown;
    for (const ReadSpan& span : spans) {
        if (span.track == "GPU" && span.name == "view") views.push_back(*span.frame);
        if (span.track == "GPU" && span.name == "display") shown.push_back(*span.frame);
    }
    CHECK_GE(views.size(), 2u);
    CHECK_LT(views.size(), shown.size());
}

TEST_CASE("viewer: meshes, environments and what is no such thing are dropped onto it") {
    Session session;
    std::ofstream(session.path("roof.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";
    std::ofstream(session.path("broken.relume")) << "nothing";
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"screenshot", "knot.exr"}},
                                            {{"drop", {"notes.txt", "broken.relume"}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "still.exr"}},
                                            {{"drop", {"roof.obj"}}},
                                            {{"frames", 2}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "roof.exr"}},
                                            {{"quit", true}}},
                                           "knot.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK_FALSE(says(outcome.err, "validation"));
    CHECK(says(outcome.err, "notes.txt: expected a bake"));
    CHECK(says(outcome.err, "broken.relume"));
    CHECK(session.bytes("knot.exr") == session.bytes("still.exr"));
    CHECK(session.bytes("knot.exr") != session.bytes("roof.exr"));
    CHECK(std::filesystem::exists(session.path("cache/relume/bakes")));
}

TEST_CASE("viewer: ends by itself after so many frames, the last of them written") {
    Session session;
    const Outcome outcome =
        session.replay({{{"wait", "settled"}}}, "knot.relume --exit-frame 5 --screenshot last.png");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK_EQ(pngSize(session.bytes("last.png")), std::pair(480, 360));
}

TEST_CASE("viewer: says what is wrong with a script, and that there is no display") {
    Session session;
    const Outcome wrong = session.replay({{{"frames", 1}}, {{"jump", 3}}}, "knot.relume");
    CHECK_EQ(wrong.exitCode, 1);
    CHECK(says(wrong.err, "script.json: step 2: expected one of double-click, drag"));
    const TemporaryFolder folder;
    const Outcome blind = runProgram(folder, RELUME_VIEWER, "", "env -u DISPLAY -u WAYLAND_DISPLAY");
    CHECK_EQ(blind.exitCode, 4);
    CHECK(says(blind.err, "relume render"));
    CHECK_EQ(runProgram(folder, RELUME_VIEWER, "--size 3x4").exitCode, 2);
    CHECK_EQ(runProgram(folder, RELUME_VIEWER, "--screenshot a.png").exitCode, 2); // of which frame?
    CHECK_EQ(runProgram(folder, RELUME_VIEWER, "--exit-frame 1 --screenshot a.jpg").exitCode, 2);
}

TEST_CASE("viewer: what cannot be opened ends a session that nobody watches") {
    Session session;
    std::ofstream(session.path("broken.relume")) << "nothing";
    const Outcome missing = session.replay(json::array(), "absent.relume");
    CHECK_EQ(missing.exitCode, 1);
    CHECK(says(missing.err, "absent.relume: there is no such file"));
    const Outcome broken = session.replay({{{"wait", "settled"}}}, "broken.relume");
    CHECK_EQ(broken.exitCode, 1);
    CHECK(says(broken.err, "broken.relume: not a .relume file"));
    const Outcome setting = session.replay({{{"wait", "settled"}}, {{"set", {{"fov", 400}}}}}, "knot.relume");
    CHECK_EQ(setting.exitCode, 1);
    CHECK(says(setting.err, "step 2: \"fov\": expected a number from 1 to 170, found 400"));
}
