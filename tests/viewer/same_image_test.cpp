// An .exr of the window has the bytes that `relume render` draws with the command that is told beside it.
#include "tests/support/capture_binding.h"
#include "tests/support/viewer_session.h"
#include "tests/support/window_image.h"

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

struct Look {
    std::string name;
    json settings;
};

json merged(const json& a, const json& b) {
    json all = a;
    all.update(b);
    return all;
}

std::vector<Look> looks() {
    const json lamps = {{"lamps",
                         {{{"azimuth", -50}, {"elevation", 35}, {"radius", 6}, {"brightness", 1.7}},
                          {{"azimuth", 120}, {"elevation", 10}, {"color", {1, 0.2, 0.1}}}}}};
    const json strokes = {{"strokes",
                           {{{"azimuth", 70}, {"elevation", 20}, {"radius", 40}, {"radiance", {0, 2, 1}}},
                            {{"azimuth", 90}, {"elevation", 35}, {"radius", 12}, {"opacity", 0.4}}}}};
    const json day = {{"day-sky", {{"day", 300}, {"hour", 9.5}, {"latitude", -20}, {"turbidity", 4}}}};
    const json gain = {{"gain", 0.3}}, rotation = {{"rotation", 47.3}}, terms = {{"terms", 2}};
    const json blend = {{"material", {{"gold", 0.6}, {"clay", 0.9}}}};
    const json painted = merged(merged(strokes, lamps), merged(gain, merged(blend, merged(terms, rotation))));
    return {{"plain", json::object()},
            {"lamps", lamps},
            {"strokes", strokes},
            {"day", day},
            {"gain", gain},
            {"blend", blend},
            {"terms", terms},
            {"rotation", rotation},
            {"threshold", {{"threshold", 300}}},
            {"centers", {{"samples", 1}}},
            {"plate", {{"ground-style", "whole"}}},
            {"faded", {{"ground-style", "fade"}}},
            {"dark-room", merged({{"gain", 0}}, lamps)},
            {"all", painted},
            {"all-day", merged(painted, day)}};
}

// All as it is at first, but for the environment.
json unchanged() {
    return {{"environment", "room.exr"},
            {"lamps", json::array()},
            {"strokes", json::array()},
            {"gain", 1},
            {"rotation", 0},
            {"terms", 0},
            {"samples", 4},
            {"material", ""},
            {"ground-style", "shadow"},
            {"coefficients", 1024}};
}

void checkIsRendered(ViewerSession& session, const std::string& words, const std::string& file) {
    CAPTURE(file);
    const std::string command = renderCommand(words, file);
    CAPTURE(command);
    const Outcome drawn = session.relume(command);
    REQUIRE_MESSAGE(drawn.exitCode == 0, drawn.err);
    CHECK(session.bytes("image.exr") == session.bytes(file));
}

} // namespace

TEST_CASE("viewer: whatever the light and the material are, `relume render` draws the same bytes") {
    ViewerSession& session = sharedSession();
    json script = {{{"wait", "settled"}}};
    for (const Look& look : looks()) {
        script.push_back({{"set", unchanged()}});
        script.push_back({{"set", look.settings}});
        script.push_back({{"wait", "settled"}});
        script.push_back({{"screenshot", look.name + ".exr"}});
    }
    script.push_back({{"quit", true}});
    const Outcome outcome = session.replay(script, "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    std::map<std::string, std::string> seen; // no two look the same
    for (const Look& look : looks()) {
        checkIsRendered(session, outcome.err, look.name + ".exr");
        const auto added = seen.emplace(session.bytes(look.name + ".exr"), look.name);
        CHECK_MESSAGE(added.second, look.name << " looks as " << added.first->second);
    }
    // A light file only where options do not say it.
    for (const char* name : {"plain", "blend", "terms", "rotation", "threshold"})
        CHECK_FALSE(std::filesystem::exists(session.path(std::string(name) + ".light.json")));
    CHECK(json::parse(session.bytes("all.light.json")).at("lamps").size() == 2);
}

TEST_CASE("viewer: a light file that moves is drawn at its moment, and turned") {
    ViewerSession& session = sharedSession();
    std::ofstream(session.path("moving.json"))
        << json{{"environment", {{"file", "room.exr"}, {"rotate", {{"keys", {{0, 0}, {10, 90}}}}}}},
                {"lamps",
                 {{{"azimuth", {{"keys", {{0, 0}, {4, 360}}}, {"repeat", true}}},
                   {"elevation", 30},
                   {"radius", 5},
                   {"radiance", {40, 30, 20}}}}}};
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"drop", {"moving.json"}}},
                                            {{"frames", 1}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "begin.exr"}},
                                            {{"set", {{"seconds", 2.7}}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "later.exr"}},
                                            {{"set", {{"rotation", -30}}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "turned.exr"}},
                                            {{"set", {{"environment", "room.exr"}, {"rotation", 0}}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "room-again.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    for (const char* file : {"begin.exr", "later.exr", "turned.exr", "room-again.exr"})
        checkIsRendered(session, outcome.err, file);
    CHECK(session.bytes("begin.exr") != session.bytes("later.exr"));
    CHECK(session.bytes("later.exr") != session.bytes("turned.exr"));
    CHECK(says(renderCommand(outcome.err, "later.exr"), "--light 'moving.json' --time=2.7"));
    CHECK_FALSE(says(renderCommand(outcome.err, "room-again.exr"), "moving.json")); // chosen after it
}

TEST_CASE("viewer: a session is drawn by `relume render`, and opened again as it was") {
    ViewerSession& session = sharedSession();
    const json look = {{"set",
                        {{"azimuth", -50},
                         {"elevation", 31},
                         {"distance", 4.5},
                         {"fov", 28},
                         {"rotation", 33},
                         {"lamps", {{{"azimuth", 10}, {"radius", 20}, {"brightness", 0.7}}}},
                         {"material", {{"clay", 0.25}, {"gold", 0.75}}},
                         {"coefficients", 300},
                         {"samples", 2},
                         {"exposure", 0.5},
                         {"background-blur", 5},
                         {"tone", "aces"},
                         {"panels", false}}}};
    const auto sessionFile = [&] {
        std::string found;
        for (const auto& file : std::filesystem::directory_iterator(session.folder().path()))
            if (file.path().string().ends_with(".session.json")) found = file.path().filename();
        return found;
    };
    const json shots = {
        {{"wait", "settled"}}, {{"frames", 3}}, {{"screenshot", "look.exr"}}, {{"screenshot", "look.png"}}};
    json script = {{{"wait", "settled"}}, look};
    script.insert(script.end(), shots.begin(), shots.end());
    script.push_back({{"key", "ctrl+S"}});
    script.push_back({{"frames", 2}});
    script.push_back({{"quit", true}});
    const Outcome saved = session.replay(script, "ring.relume");
    CAPTURE(saved.err);
    REQUIRE_EQ(saved.exitCode, 0);
    CHECK(isQuiet(saved.err));
    const std::string file = sessionFile();
    REQUIRE_NE(file, "");
    for (const char* image : {"look.exr", "look.png"}) {
        CAPTURE(image);
        const std::string own = std::string("own-") + image;
        const Outcome drawn = session.relume("render --session " + file + " -o " + own);
        REQUIRE_MESSAGE(drawn.exitCode == 0, drawn.err);
        if (own.ends_with(".exr"))
            CHECK(session.bytes(own) == session.bytes(image));
        else // the device rounds a few display values to another of 255 steps
            CHECK_LT(differingPixels(windowImage(session.path(own)), windowImage(session.path(image))), 200);
    }
    // Options that are given win.
    REQUIRE_EQ(session.relume("render --session " + file + " --orbit 0,90,2 -m gold -o other.exr").exitCode,
               0);
    CHECK(session.bytes("other.exr") != session.bytes("look.exr"));

    json again = shots;
    for (json& step : again)
        if (step.contains("screenshot"))
            step["screenshot"] = "again-" + step["screenshot"].get<std::string>();
    again.push_back({{"quit", true}});
    const Outcome opened = session.replay(again, file);
    CAPTURE(opened.err);
    REQUIRE_EQ(opened.exitCode, 0);
    const Image first = readImage(session.path("look.exr")).image,
                second = readImage(session.path("again-look.exr")).image;
    double difference = 0, sum = 0;
    for (size_t i = 0; i < first.pixels.size(); i++) {
        const vec3 off = vec3(first.pixels[i]) - vec3(second.pixels[i]);
        difference += double(glm::dot(off, off));
        sum += double(glm::dot(vec3(first.pixels[i]), vec3(first.pixels[i])));
    }
    CHECK_LT(std::sqrt(difference / sum), 1e-3); // the camera is kept as angles, the lamp as a brightness

    // A session that opens itself, or what is no model, is refused.
    for (const char* bake : {"look.session.json", "room.exr", "nothing.xyz"}) {
        std::ofstream(session.path("look.session.json"))
            << json{{"session", 1}, {"bake", bake}, {"eye", {0, 0, 5}}, {"target", {0, 0, 0}}};
        const Outcome refused = session.replay({{{"quit", true}}}, "look.session.json");
        CHECK_EQ(refused.exitCode, 1);
        CHECK(says(refused.err, bake));
    }
}

TEST_CASE(
    "viewer: a session of a bake that is open, but not shown, shows it, and the residual is no matter of a "
    "sketch") {
    ViewerSession& session = sharedSession();
    session.bake("other.relume", "-m clay");
    std::ofstream(session.path("back.json"))
        << json{{"session", 1}, {"bake", "ring.relume"}, {"eye", {0, 3, 5}}, {"target", {0, 0, 0}}};
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"drop", {"back.json"}}},
                                            {{"frames", 2}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "back.exr"}},
                                            {{"drop", {"ring.obj"}}},
                                            {{"set", {{"residual", false}}}},
                                            {{"frames", 3}},
                                            {{"screenshot", "any.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume other.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    CHECK(says(renderCommand(outcome.err, "back.exr"), "/ring.relume'"));
    CHECK(says(renderCommand(outcome.err, "back.exr"), "--eye=0,3"));
    const Image any = readImage(session.path("any.exr")).image;
    CHECK(std::ranges::any_of(any.pixels, [](const vec4& pixel) { return pixel.x > 0; }));
}

TEST_CASE("cli: sessions are data: keys of a look alone, and options that are given win") {
    ViewerSession& session = sharedSession();
    const json look = {{"session", 1},    {"bake", "ring.relume"}, {"eye", {0, 3, 5}}, {"target", {0, 0, 0}},
                       {"exposure", 0.3}, {"background-blur", 4},  {"size", "40x30"}};
    const auto render = [&](json more, const std::string& options) {
        more.update(look);
        std::ofstream(session.path("data.json")) << more;
        return session.relume("render --session data.json " + options);
    };
    std::ofstream(session.path("kept.json")) << "kept";
    const std::vector<std::pair<json, std::string>> refused = {
        {{{"timings", "kept.json"}}, "unknown key \"timings\""},
        {{{"frames", 3}}, "unknown key"},
        {{{"exposur", 1}}, "did you mean \"exposure\""},
        {{{"environment", "room.exr"}, {"light", json::object()}}, "\"environment\""},
        {{{"threshold", 64}, {"coefficients", 64}}, "\"threshold\""},
        {{{"ground-style", "maybe"}}, "\"ground-style\""},
        {{{"material", "gold"}}, "\"material\""},
        {{{"tone", "sepia"}}, "\"tone\""},
    };
    for (const auto& [more, why] : refused) {
        CAPTURE_BINDING(more.dump());
        const Outcome outcome = render(more, "-o data.png");
        CHECK_EQ(outcome.exitCode, 1);
        CHECK(says(outcome.err, "data.json"));
        CHECK(says(outcome.err, why));
    }
    CHECK_EQ(session.bytes("kept.json"), "kept");
    for (const char* options : {"-o data.png", "-o data.exr", "-o data.png --background none",
                                "-o data.png --background '#ffffff'", "-o data.png --exposure auto"}) {
        CAPTURE(options);
        const Outcome outcome = render(json::object(), options);
        CHECK_MESSAGE(outcome.exitCode == 0, outcome.err);
    }
    CHECK_EQ(render({{"background", "none"}}, "-o data.png --background-blur 5").exitCode, 0);
    std::ofstream(session.path("data.json"))
        << json{{"session", 1}, {"bake", "ring.relume"}, {"eye", {0, 0, 1e-30}}, {"target", {0, 0, 0}}};
    CHECK(says(session.relume("render --session data.json -o data.png").err, "other than the target"));
}

TEST_CASE("viewer: the built-in sky and a lamp have a light file") {
    ViewerSession& session = sharedSession();
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"screenshot", "sky.exr"}},
                                            {{"set", {{"lamps", {{{"azimuth", 10}}}}}}},
                                            {{"wait", "settled"}},
                                            {{"screenshot", "sky-and-lamp.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    checkIsRendered(session, outcome.err, "sky.exr");
    checkIsRendered(session, outcome.err, "sky-and-lamp.exr");
    CHECK(session.bytes("sky.exr") != session.bytes("sky-and-lamp.exr"));
}

TEST_CASE("viewer: a kept view comes back with its field of view") {
    ViewerSession& session = sharedSession();
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"screenshot", "narrow.exr"}},
                                            {{"key", "ctrl+1"}},
                                            {{"set", {{"fov", 60}, {"azimuth", 100}}}},
                                            {{"frames", 2}},
                                            {{"screenshot", "wide.exr"}},
                                            {{"key", "1"}},
                                            {{"screenshot", "narrow-again.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    for (const char* file : {"narrow.exr", "wide.exr", "narrow-again.exr"})
        checkIsRendered(session, outcome.err, file);
    CHECK(session.bytes("narrow.exr") == session.bytes("narrow-again.exr"));
    CHECK(session.bytes("narrow.exr") != session.bytes("wide.exr"));
}
