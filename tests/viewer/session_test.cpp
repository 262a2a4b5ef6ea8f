// Session files as they are written and read, without a window.
#include "apps/viewer/session.h"

#include "apps/viewer/screenshot.h"
#include "tests/support/failure.h"
#include "tests/support/temporary_folder.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

SceneState shownState() {
    using Kind = EnvironmentChoice::Kind;
    SceneState state;
    state.orbit = Orbit();
    state.light.environments = {{.kind = Kind::BuiltIn, .name = "sky"},
                                {.kind = Kind::DaySky, .name = "day sky"}};
    return state;
}

// Sessions of a bake that is there.
struct SessionFolder : TemporaryFolder {
    SessionFolder() { write("a.relume", "bake"); }

    Session read(const json& session) const {
        return readSession(write("a.session.json", session.dump()), shownState());
    }
    // Reads the smallest valid session, with these values added or replaced.
    Session readWith(const json& values) const {
        json session = {{"session", 1}, {"bake", "a.relume"}, {"eye", {0, 3, 5}}, {"target", {0, 0, 0}}};
        session.update(values);
        return read(session);
    }
};

} // namespace

TEST_CASE("session: materials come back with their weights, whatever their names are") {
    const SessionFolder folder;
    const std::vector<std::vector<WeightedMaterial>> blends = {
        {{"gold"}},
        {{"oak=dark"}},
        {{"oak=0.5"}},
        {{"=", 0.25f}},
        {{"oak=1", 0.3f}, {"oak", 0.7f}},
        {{"clay", 0}, {"gold", 1e6f}},
    };
    for (const std::vector<WeightedMaterial>& blend : blends) {
        CAPTURE(blend[0].name);
        SceneState state = shownState();
        state.material = blend;
        const auto written = sessionOf(state, GroundStyle::Whole, folder.path() / "a.relume", "", {40, 30});
        CHECK((folder.read(written).material == blend));
    }
}

TEST_CASE("session: the command of a picture tells the weight of a material whose name has an equals sign") {
    SceneState state = shownState();
    const auto commandOf = [&] {
        return renderCommand(renderOptions(state, GroundStyle::Whole, Drawn::Picture), "a.relume", 40, 30,
                             Drawn::Picture);
    };
    state.material = {{"oak=0.5"}};
    CHECK_NE(commandOf().find("--material 'oak=0.5=1'"), std::string::npos);
    state.material = {{"oak"}};
    CHECK_NE(commandOf().find("--material 'oak' "), std::string::npos);
}

TEST_CASE("session: materials that `relume render` refuses are refused") {
    const SessionFolder folder;
    for (const json& material : {json::array({"gold="}), json::array({"gold=-1"}), json::array({"gold=1e7"}),
                                 json::array({"gold= 1"}), json::array({"gold=nan"}),
                                 json::array({"gold", "gold=2"}), json::array({"gold=0"})}) {
        CAPTURE(material.dump());
        CHECK_THROWS_WITH_AS(folder.readWith({{"material", material}}), doctest::Contains("\"material\""),
                             Error);
    }
}

TEST_CASE("session: values of other types, and pairs that exclude each other, are refused by name") {
    const SessionFolder folder;
    const auto refuses = [&](const char* key, const json& value, const std::string& expected) {
        const std::string failure = failureOf([&] { folder.readWith({{key, value}}); });
        CAPTURE(key);
        CAPTURE(value.dump());
        CAPTURE(failure);
        CHECK(says(failure, std::string("a.session.json: \"") + key + "\": expected " + expected));
    };
    REQUIRE_NOTHROW(folder.readWith({{"fov", 40}}));
    refuses("session", 2, "version 1");
    refuses("session", "1", "numbers");
    refuses("bake", json(), "a .relume file");
    for (const char* key : {"model", "environment", "size", "residual", "tone", "background", "ground-style"})
        for (const json& value : {json(7), json(""), json::array({"a"})}) refuses(key, value, "a text");
    for (const char* key : {"eye", "target"}) {
        for (const json& value : {json(), json(7), json({0, 1})}) refuses(key, value, "three numbers");
        for (const json& value : {json({0, 1e7, 0}), json({"0", 0, 0})}) refuses(key, value, "numbers from");
    }
    refuses("eye", {0, 0, 0}, "a point other than the target");
    for (const char* key : {"fov", "rotate", "coefficients", "threshold", "time", "samples", "terms",
                            "exposure", "background-blur"})
        for (const json& value : {json("7"), json(1e7), json(-1e7)}) refuses(key, value, "numbers from");
    refuses("light", 7, "a text");
    for (const json& value : {json("gold"), json::array(), json::array({7})})
        refuses("material", value, "a list of names");
    const auto refusesPair = [&](const json& pair, const char* said) {
        CHECK(says(failureOf([&] { folder.readWith(pair); }), said));
    };
    refusesPair({{"environment", "a.exr"}, {"light", "b.json"}}, "no such key beside \"light\"");
    refusesPair({{"threshold", 0.1}, {"coefficients", 64}}, "no such key beside \"coefficients\"");
}
