// An .exr of the window has the bytes that `relume render` draws with the command that is told beside it.
#include "tests/support/viewer_session.h"

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
            {"plate", {{"ground-fade", false}}},
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
            {"ground-fade", true},
            {"coefficients", 512}};
}

void checkIsRendered(Session& session, const std::string& words, const std::string& file) {
    CAPTURE(file);
    const std::string command = renderCommand(words, file);
    CAPTURE(command);
    const Outcome drawn = session.relume(command);
    REQUIRE_MESSAGE(drawn.exitCode == 0, drawn.err);
    CHECK(session.bytes("image.exr") == session.bytes(file));
}

} // namespace

TEST_CASE("viewer: whatever the light and the material are, `relume render` draws the same bytes") {
    Session& session = sharedSession();
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
        const auto [other, isNew] = seen.emplace(session.bytes(look.name + ".exr"), look.name);
        CHECK_MESSAGE(isNew, look.name << " looks as " << other->second);
    }
    // A light file only where options do not say it.
    for (const char* name : {"plain", "blend", "terms", "rotation", "threshold"})
        CHECK_FALSE(std::filesystem::exists(session.path(std::string(name) + ".light.json")));
    CHECK(json::parse(session.bytes("all.light.json")).at("lamps").size() == 2);
}

TEST_CASE("viewer: a light file that moves is drawn at its moment, and turned") {
    Session& session = sharedSession();
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
    CHECK(says(renderCommand(outcome.err, "later.exr"), "--light 'moving.json' --time 2.7"));
    CHECK_FALSE(says(renderCommand(outcome.err, "room-again.exr"), "moving.json")); // chosen after it
}

TEST_CASE("viewer: says no command where no file says what the light is") {
    Session& session = sharedSession();
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
    CHECK_EQ(renderCommand(outcome.err, "sky-and-lamp.exr"), "");
    CHECK(session.bytes("sky.exr") != session.bytes("sky-and-lamp.exr"));
}

TEST_CASE("viewer: a kept view comes back with its field of view") {
    Session& session = sharedSession();
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
