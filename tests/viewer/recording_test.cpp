// Numbered images of what the window shows.
#include "apps/viewer/outputs.h"
#include "engine/base/error.h"
#include "tests/support/viewer_session.h"
#include "tests/support/window_image.h"

#include <fmt/core.h>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

TEST_CASE("viewer: a recording has every frame, numbered, as large as the window") {
    ViewerSession& session = sharedSession();
    // Stands in for ffmpeg: writes what it was asked for into the video.
    std::filesystem::create_directory(session.path("tools"));
    const std::filesystem::path ffmpeg = session.path("tools") / "ffmpeg";
    std::ofstream(ffmpeg) << "#!/bin/sh\nfor video; do :; done\necho \"$@\" > \"$video\"\n";
    std::filesystem::permissions(ffmpeg, std::filesystem::perms::owner_all);
    const Outcome outcome =
        session.replay({{{"wait", "settled"}},
                        {{"set", {{"turntable", true}}}},
                        {{"key", "ctrl+F12"}},
                        {{"frames", 12}},
                        {{"key", "ctrl+F12"}},
                        {{"set", {{"turntable", false}}}},
                        {{"wait", "settled"}},
                        {{"quit", true}}},
                       "ring.relume", "PATH=" + session.path("tools").string() + ":$PATH");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    std::filesystem::path folder;
    for (const auto& entry : std::filesystem::directory_iterator(session.path("")))
        if (entry.is_directory() && entry.path().filename().string().starts_with("relume-")) folder = entry;
    REQUIRE_FALSE(folder.empty());
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename());
    std::ranges::sort(names);
    // From the frame of the first key to that before the second.
    REQUIRE_EQ(names.size(), 13u);
    std::string last;
    for (size_t i = 0; i < names.size(); i++) {
        CAPTURE(names[i]);
        CHECK_EQ(names[i], fmt::format("frame_{:04}.png", i + 1));
        const std::string image = contents(folder / names[i]);
        CHECK_EQ(pngSize(image), std::pair(kSessionWidth, kSessionHeight));
        CHECK(image != last); // it turns
        last = image;
    }
    CHECK(says(outcome.err, folder.filename().string() + ": 13 images"));
    const std::string video = contents(folder.string() + ".mp4");
    CHECK(says(video, folder.filename().string() + "/frame_%04d.png"));
    CHECK(says(video, "-framerate 30"));
    CHECK(says(outcome.err, folder.filename().string() + ".mp4 is made of the images"));
}

TEST_CASE("viewer: G draws the contact sheet that `relume sheet` draws, beside the frames") {
    ViewerSession& session = sharedSession();
    const Outcome outcome =
        session.replay({{{"wait", "settled"}}, {{"key", "G"}}, {{"wait", "settled"}}, {{"quit", true}}},
                       "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    std::filesystem::path file;
    for (const auto& entry : std::filesystem::directory_iterator(session.path("")))
        if (entry.path().string().ends_with("-sheet.png")) file = entry;
    REQUIRE_FALSE(file.empty());
    CHECK(says(outcome.err, file.filename().string() + " is written"));
    const Outcome sheet = session.relume("sheet ring.relume -e room.exr -o sheet.png");
    REQUIRE_MESSAGE(sheet.exitCode == 0, sheet.err);
    const Image drawn = windowImage(file), expected = windowImage(session.path("sheet.png"));
    REQUIRE_EQ(drawn.height, expected.height); // both materials
    REQUIRE_GT(drawn.width, expected.width);   // other lights stand before that of the file
    const int left = drawn.width - expected.width;
    size_t different = 0;
    for (int y = 0; y < expected.height; y++)
        for (int x = 0; x < expected.width; x++) different += drawn.at(left + x, y) != expected.at(x, y);
    CHECK_EQ(different, 0u);
}

TEST_CASE("outputs: a light or session is written over nothing but .json") {
    const TemporaryFolder folder;
    const std::filesystem::path bake = folder.path() / "knot.relume";
    std::ofstream(bake) << "a bake";
    CHECK_THROWS_WITH_AS(writeJsonFile(bake, {}), doctest::Contains("expected a name ending in .json"),
                         Error);
    CHECK_EQ(contents(bake), "a bake");
    writeJsonFile(folder.path() / "look.json", {{"session", 1}});
    CHECK(says(contents(folder.path() / "look.json"), "\"session\": 1"));
}
