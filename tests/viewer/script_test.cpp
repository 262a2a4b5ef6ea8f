// What scripts do: inputs, settings, files; and how a session ends.
#include "apps/viewer/opened_file.h"
#include "apps/viewer/script.h"
#include "engine/base/error.h"
#include "tests/support/viewer_session.h"

using namespace relume;
using namespace relume::test;
using nlohmann::json;

TEST_CASE("viewer: a settled view has the bytes that `relume render` draws") {
    ViewerSession session;
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
                       "ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    REQUIRE_EQ(session.relume(renderCommand(outcome.err, "small.exr")).exitCode, 0);
    CHECK(session.bytes("image.exr") == session.bytes("small.exr"));
    CHECK_EQ(readImage(session.path("small.exr")).image.width, 400);

    REQUIRE_EQ(session.relume(renderCommand(outcome.err, "view.exr")).exitCode, 0);
    CHECK(session.bytes("image.exr") == session.bytes("view.exr"));
    CHECK(session.bytes("first.exr") != session.bytes("view.exr"));
    CHECK_EQ(pngSize(session.bytes("window.png")), std::pair(480, 360));
}

TEST_CASE("viewer: a scene to bake, and what cannot be opened, are dropped onto it") {
    ViewerSession session;
    std::ofstream(session.path("roof.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n";
    std::ofstream(session.path("roof.json"))
        << R"({"parts": [{"mesh": "roof.obj", "material": "white-diffuse"}]})";
    std::ofstream(session.path("broken.relume")) << "nothing";
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"screenshot", "ring.exr"}},
                                            {{"drop", {"notes.txt", "broken.relume"}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "still.exr"}},
                                            {{"drop", {"roof.json"}}},
                                            {{"frames", 2}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "roof.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK_FALSE(says(outcome.err, "validation"));
    CHECK(says(outcome.err, "notes.txt: expected a bake"));
    CHECK(says(outcome.err, "broken.relume"));
    CHECK(session.bytes("ring.exr") == session.bytes("still.exr"));
    CHECK(session.bytes("ring.exr") != session.bytes("roof.exr"));
    CHECK(std::filesystem::exists(session.path("cache/relume/bakes")));
}

TEST_CASE("viewer: ends by itself after so many frames, the last of them written") {
    ViewerSession session;
    const Outcome outcome =
        session.replay({{{"wait", "settled"}}}, "ring.relume --exit-frame 5 --screenshot last.png");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK_EQ(pngSize(session.bytes("last.png")), std::pair(480, 360));
}

TEST_CASE("viewer: says what is wrong with a script, and that there is no display") {
    ViewerSession session;
    const Outcome wrong = session.replay({{{"frames", 1}}, {{"jump", 3}}}, "ring.relume");
    CHECK_EQ(wrong.exitCode, 1);
    CHECK(says(wrong.err, "script.json: step 2: expected one of click, double-click, drag"));
    const TemporaryFolder folder;
    const Outcome blind = runProgram(folder, RELUME_VIEWER, "", "env -u DISPLAY -u WAYLAND_DISPLAY");
    CHECK_EQ(blind.exitCode, 4);
    CHECK(says(blind.err, "relume render"));
    CHECK_EQ(runProgram(folder, RELUME_VIEWER, "--size 3x4").exitCode, 2);
    CHECK_EQ(runProgram(folder, RELUME_VIEWER, "--screenshot a.png").exitCode, 2); // of which frame?
    CHECK_EQ(runProgram(folder, RELUME_VIEWER, "--exit-frame 1 --screenshot a.jpg").exitCode, 2);
}

TEST_CASE("viewer: steps that cannot be done are refused before the first") {
    const TemporaryFolder folder;
    const auto expectRefused = [&](const json& step, const char* why) {
        const auto file = folder.write("script.json", json::array({{{"frames", 1}}, step}).dump());
        CHECK_THROWS_WITH_AS(Script{file}, doctest::Contains(why), Error);
        CHECK_THROWS_WITH_AS(Script{file}, doctest::Contains("script.json: step 2: "), Error);
    };
    expectRefused({{"frames", -1}}, "\"frames\": expected a whole number from 0");
    expectRefused({{"frames", 1.5}}, "whole number");
    expectRefused({{"wait", -5}}, "\"wait\": expected \"settled\", \"shown\", 0 to");
    expectRefused({{"wait", "long"}}, "found \"long\"");
    expectRefused({{"wait", {{"passes", -1}}}}, "\"passes\"");
    expectRefused({{"frames", 2}, {"quit", true}}, "a step does one thing");
    expectRefused({{"drag", "left"}, {"from", {1, 2}}, {"by", {3, 4}}, {"over", 0}}, "\"over\"");
    expectRefused({{"wheel", 1}, {"over", 2}}, "\"over\" is no part of \"wheel\"");
    expectRefused({{"resize", {0, 0}}}, "\"resize\": expected a whole number from 320");
    expectRefused({{"resize", {800, 1e9}}}, "\"resize\"");
    expectRefused({{"resize", {800}}}, "");
    expectRefused(7, "expected an object");
    const auto deep = folder.write("deep.json", std::string(1 << 20, '[') + std::string(1 << 20, ']'));
    CHECK_THROWS_WITH_AS(Script{deep}, doctest::Contains("nested deeper"), Error);
    CHECK_THROWS_WITH_AS(kindOf(deep), doctest::Contains("nested deeper"), Error);
    CHECK_NOTHROW(
        Script(folder.write("script.json", R"([{"wait": {"passes": 8}}, {"key": "A", "at": [1, 2]}])")));
}

TEST_CASE("viewer: what cannot be opened ends a session that nobody watches") {
    ViewerSession session;
    std::ofstream(session.path("roof.json"))
        << R"({"parts": [{"mesh": "roof.obj", "material": "white-diffuse"}]})";
    std::ofstream(session.path("broken.relume")) << "nothing";
    const Outcome missing = session.replay(json::array(), "absent.relume");
    CHECK_EQ(missing.exitCode, 1);
    CHECK(says(missing.err, "absent.relume: there is no such file"));
    const Outcome broken = session.replay({{{"wait", "settled"}}}, "broken.relume");
    CHECK_EQ(broken.exitCode, 1);
    CHECK(says(broken.err, "broken.relume: not a .relume file"));
    const Outcome endless =
        session.replay({{{"wait", "settled"}}, {{"wait", {{"passes", 2}}}}}, "ring.relume");
    CHECK_EQ(endless.exitCode, 1);
    CHECK(says(endless.err, "step 2: \"passes\": nothing is compared"));
    const Outcome setting = session.replay({{{"wait", "settled"}}, {{"set", {{"fov", 400}}}}}, "ring.relume");
    CHECK_EQ(setting.exitCode, 1);
    CHECK(says(setting.err, "step 2: \"fov\": expected a number from 1 to 170, found 400"));
}

TEST_CASE("viewer: an environment that cannot be read leaves the sky, however often it is chosen") {
    ViewerSession& session = sharedSession();
    const json choose = {{"set", {{"environment", "late.exr"}}}};
    const Outcome missing = session.replay({{{"wait", "settled"}},
                                            {{"screenshot", "sky.exr"}},
                                            choose,
                                            {{"wait", "settled"}},
                                            {{"screenshot", "first.exr"}},
                                            choose,
                                            {{"wait", "settled"}},
                                            {{"screenshot", "second.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume");
    CAPTURE(missing.err);
    REQUIRE_EQ(missing.exitCode, 0);
    const std::string words = "late.exr: cannot be read";
    const size_t told = missing.err.find(words);
    REQUIRE_NE(told, std::string::npos);
    CHECK_NE(missing.err.find(words, told + 1), std::string::npos);
    CHECK(session.bytes("first.exr") == session.bytes("sky.exr"));
    CHECK(session.bytes("second.exr") == session.bytes("sky.exr"));
    CHECK_EQ(renderCommand(missing.err, "second.exr"), renderCommand(missing.err, "sky.exr"));
}
