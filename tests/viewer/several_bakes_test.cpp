// More than one bake in a window.
#include "tests/support/viewer_session.h"

using namespace relume;
using namespace relume::test;
using nlohmann::json;

TEST_CASE("viewer: B goes from bake to bake, and the same mesh stays where it is") {
    ViewerSession& session = sharedSession();
    session.bake("coarse.relume", "-m clay");
    const Outcome baked =
        session.relume("bake " + ballIn(session.folder()) +
                       " -m clay -K 2 -N 24 --bounces 0 --visibility-size 64 --face-size 32 "
                       "--map-size 16 -q -o ball.relume");
    REQUIRE_MESSAGE(baked.exitCode == 0, baked.err);
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"set", {{"azimuth", 75}, {"material", "gold"}}}},
                                            {{"wait", "settled"}},
                                            {{"key", "B"}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "one.exr"}},
                                            {{"key", "B"}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "two.exr"}},
                                            {{"key", "B"}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "three.exr"}},
                                            {{"key", "B"}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "one-again.exr"}},
                                            {{"quit", true}}},
                                           "ball.relume coarse.relume ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    std::map<std::string, std::string> commands;
    for (const char* file : {"one.exr", "two.exr", "three.exr", "one-again.exr"}) {
        CAPTURE(file);
        commands[file] = renderCommand(outcome.err, file);
        const Outcome drawn = session.relume(commands[file]);
        REQUIRE_MESSAGE(drawn.exitCode == 0, drawn.err);
        CHECK(session.bytes("image.exr") == session.bytes(file));
    }
    // The one read last is shown first, and the next after it is the first.
    CHECK(says(commands["one.exr"], "'ball.relume'"));
    CHECK(says(commands["two.exr"], "'coarse.relume'"));
    CHECK(says(commands["three.exr"], "'ring.relume'"));
    CHECK_EQ(commands["one-again.exr"], commands["one.exr"]);
    const auto cameraOf = [](const std::string& command) {
        const size_t eye = command.find("--eye=");
        return command.substr(eye, command.find(" --rotate") - eye);
    };
    CHECK_EQ(cameraOf(commands["two.exr"]), cameraOf(commands["three.exr"]));
    CHECK_NE(cameraOf(commands["one.exr"]), cameraOf(commands["two.exr"])); // about the same middle
}

TEST_CASE("viewer: a mesh is shown before anything of it is baked, and the session names it") {
    ViewerSession& session = sharedSession();
    const Outcome outcome = session.replay({{{"wait", "shown"}},
                                            {{"screenshot", "sketch.exr"}},
                                            {{"key", "ctrl+S"}},
                                            {{"frames", 2}},
                                            {{"quit", true}}},
                                           "ring.obj room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    const Image sketch = readImage(session.path("sketch.exr")).image;
    const size_t covered = size_t(std::ranges::count_if(
        sketch.pixels, [](const vec4& pixel) { return pixel.w == 1 && pixel.x + pixel.y + pixel.z > 0; }));
    CHECK_GT(covered, sketch.pixels.size() / 8);
    bool isNamed = false;
    for (const auto& file : std::filesystem::directory_iterator(session.folder().path()))
        if (file.path().string().ends_with(".session.json"))
            isNamed |= json::parse(session.bytes(file.path().filename())).value("model", "") ==
                       session.path("ring.obj").string();
    CHECK(isNamed);
}
