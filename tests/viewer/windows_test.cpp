// Windows and marks over the view, modes of inspection, the focus: what they change, and what they do not.
#include "tests/support/capture_binding.h"
#include "tests/support/viewer_session.h"
#include "tests/support/window_image.h"

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

json shots(const std::string& name) {
    return {{{"wait", "settled"}}, {{"screenshot", name + ".png"}}, {{"screenshot", name + ".exr"}}};
}

void append(json& script, const json& steps) { script.insert(script.end(), steps.begin(), steps.end()); }

} // namespace

TEST_CASE("viewer: why and the light vector are asked for, and leave the view as it is") {
    ViewerSession& session = sharedSession();
    // The middle of the ring is seen through; below it is its near side.
    const std::vector<std::pair<std::string, json>> asked = {
        {"nothing", {{"frames", 1}}},
        {"why", {{"key", "W"}, {"at", {240, 235}}}},
        {"why-ground", {{"key", "W"}, {"at", {60, 200}}}},
        {"why-beside", {{"key", "W"}, {"at", {240, 5}}}},
        {"light", {{"key", "L"}}},
        {"no-light", {{"key", "L"}}},
        {"help", {{"key", "H"}}},
        {"no-help", {{"key", "H"}}},
        {"no-panels", {{"key", "Tab"}}},
    };
    json script = {{{"wait", "settled"}}, {{"set", {{"dark", true}}}}};
    for (const auto& [name, step] : asked) {
        script.push_back(step);
        append(script, shots(name));
    }
    script.push_back({{"quit", true}});
    const Outcome outcome = session.replay(script, "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    for (const auto& [name, step] : asked) {
        CAPTURE_BINDING(name);
        CHECK(session.bytes(name + ".exr") == session.bytes("nothing.exr"));
    }
    // Times and notices in the panels are never the same.
    constexpr int kSmallest = 30000;
    const auto differing = [&](const char* a, const char* b) {
        return differingPixels(windowImage(session.path(std::string(a) + ".png")),
                               windowImage(session.path(std::string(b) + ".png")));
    };
    for (const char* name : {"why", "why-ground", "light", "help", "no-panels"}) {
        CAPTURE(name);
        CHECK_GT(differing(name, "nothing"), kSmallest);
    }
    for (const char* name : {"why-beside", "no-light", "no-help"}) {
        CAPTURE(name);
        CHECK_LT(differing(name, "nothing"), kSmallest);
    }
}

TEST_CASE("viewer: each mode of inspection has an image of its own, which nothing else draws") {
    ViewerSession& session = sharedSession();
    json script = {{{"wait", "settled"}}, {{"set", {{"panels", false}}}}};
    const std::vector<std::string> modes = {"off", "wireframe", "normals", "density", "off-again"};
    for (const std::string& mode : modes) {
        if (mode != "off") script.push_back({{"key", "I"}});
        append(script, shots(mode));
    }
    script.push_back({{"set", {{"inspect", "normals"}, {"compare", "split"}}}}); // nothing is compared
    append(script, shots("normals-again"));
    script.push_back({{"quit", true}});
    const Outcome outcome = session.replay(script, "ring.relume room.exr");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    for (const char* extension : {".png", ".exr"}) {
        std::map<std::string, std::string> seen;
        for (const std::string mode : {"off", "wireframe", "normals", "density"}) {
            CAPTURE(mode);
            CHECK(seen.emplace(session.bytes(mode + extension), mode).second);
        }
        CHECK(session.bytes(std::string("off-again") + extension) ==
              session.bytes(std::string("off") + extension));
        CHECK(session.bytes(std::string("normals-again") + extension) ==
              session.bytes(std::string("normals") + extension));
    }
    CHECK_NE(renderCommand(outcome.err, "off.exr"), "");
    CHECK_EQ(renderCommand(outcome.err, "normals.exr"), ""); // `relume render` has no such modes
}

TEST_CASE("viewer: a double click looks at what is there") {
    ViewerSession& session = sharedSession();
    const Outcome outcome = session.replay({{{"wait", "settled"}},
                                            {{"screenshot", "before.exr"}},
                                            {{"double-click", {240, 235}}},
                                            {{"frames", 2}},
                                            {{"screenshot", "focused.exr"}},
                                            {{"double-click", {240, 5}}}, // nothing is there
                                            {{"frames", 2}},
                                            {{"screenshot", "same.exr"}},
                                            {{"quit", true}}},
                                           "ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    const std::string before = renderCommand(outcome.err, "before.exr"),
                      focused = renderCommand(outcome.err, "focused.exr");
    CHECK(says(before, "--target=0,0,0 "));
    const auto vectorOf = [](const std::string& command, const std::string& option) {
        vec3 v(0);
        const size_t place = command.find(option);
        REQUIRE_NE(place, std::string::npos);
        REQUIRE_EQ(std::sscanf(command.c_str() + place + option.size(), "%f,%f,%f", &v.x, &v.y, &v.z), 3);
        return v;
    };
    const vec3 target = vectorOf(focused, "--target="), eye = vectorOf(focused, "--eye=");
    // On the ring, about Y: 0.4 from its circle of radius 1, but for its facets.
    const float fromAxis = std::hypot(target.x, target.z);
    CHECK(std::hypot(fromAxis - 1, target.y) == doctest::Approx(0.4).epsilon(0.03));
    // On the near side; half as far away, seen from the same side.
    const vec3 was = vectorOf(before, "--eye=");
    CHECK_GT(glm::dot(target, was), 0);
    CHECK(glm::length(eye - target) == doctest::Approx(0.5 * glm::length(was)).epsilon(1e-4));
    CHECK(glm::dot(glm::normalize(eye - target), glm::normalize(was)) == doctest::Approx(1).epsilon(1e-5));
    REQUIRE_EQ(session.relume(focused).exitCode, 0);
    CHECK(session.bytes("image.exr") == session.bytes("focused.exr"));
    CHECK(session.bytes("same.exr") == session.bytes("focused.exr"));
}

TEST_CASE("viewer: a lamp is dragged over the object, and nothing else with it") {
    ViewerSession& session = sharedSession();
    // Its handle is in the middle of the window.
    const json drag = {{"drag", "left"}, {"from", {240, 180}}, {"by", {-40, -30}}, {"over", 3}};
    const Outcome outcome =
        session.replay({{{"wait", "settled"}},
                        {{"set", {{"azimuth", 30}, {"elevation", 20}, {"rotation", 10}, {"gain", 0}}}},
                        {{"set", {{"lamps", {{{"azimuth", 20}, {"elevation", 20}}}}}}},
                        {{"wait", "settled"}},
                        {{"screenshot", "lamp.exr"}},
                        drag,
                        {{"wait", "settled"}},
                        {{"screenshot", "dragged.exr"}},
                        {{"key", "Tab"}}, // without panels, it is the view that is dragged
                        drag,
                        {{"wait", "settled"}},
                        {{"screenshot", "orbited.exr"}},
                        {{"quit", true}}},
                       "ring.relume");
    CAPTURE(outcome.err);
    REQUIRE_EQ(outcome.exitCode, 0);
    CHECK(isQuiet(outcome.err));
    const auto cameraOf = [&](const char* file) {
        const std::string command = renderCommand(outcome.err, file);
        const size_t eye = command.find("--eye=");
        REQUIRE_NE(eye, std::string::npos);
        return command.substr(eye, command.find(" --rotate") - eye);
    };
    const auto lampOf = [&](const char* file) { return json::parse(session.bytes(file)).at("lamps").at(0); };
    CHECK_EQ(cameraOf("lamp.exr"), cameraOf("dragged.exr"));
    CHECK_NE(cameraOf("lamp.exr"), cameraOf("orbited.exr"));
    CHECK(session.bytes("lamp.exr") != session.bytes("dragged.exr"));
    const json before = lampOf("lamp.light.json"), after = lampOf("dragged.light.json");
    CHECK_LT(after.at("azimuth"), before.at("azimuth").get<float>() - 4); // to the left, and up
    CHECK_GT(after.at("elevation"), before.at("elevation").get<float>() + 3);
    CHECK_EQ(after.at("radiance"), before.at("radiance"));
    CHECK_EQ(lampOf("orbited.light.json"), after);
    REQUIRE_EQ(session.relume(renderCommand(outcome.err, "dragged.exr")).exitCode, 0);
    CHECK(session.bytes("image.exr") == session.bytes("dragged.exr"));
}
