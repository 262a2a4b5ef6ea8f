// Session files as they are written and read, without a window.
#include "apps/viewer/session.h"

#include "apps/viewer/screenshot.h"
#include "engine/base/error.h"
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
    Session readWith(const json& material) const {
        return read({{"session", 1},
                     {"bake", "a.relume"},
                     {"eye", {0, 3, 5}},
                     {"target", {0, 0, 0}},
                     {"material", material}});
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
        CHECK_THROWS_WITH_AS(folder.readWith(material), doctest::Contains("\"material\""), Error);
    }
}
