#include "apps/viewer/scene_state.h"

#include <doctest/doctest.h>

using namespace relume;

TEST_CASE("scene state: materials follow each other, and what was baked after the last") {
    SceneState state;
    const std::vector<std::string> names = {"clay", "gold"};
    for (const char* expected : {"clay", "gold", "", "clay"}) {
        bindNextMaterial(state, names);
        CHECK_EQ(state.material.empty() ? "" : state.material[0].name, expected);
    }
    state.material = {{"steel"}}; // of another bake
    bindNextMaterial(state, names);
    CHECK(state.material.at(0).name == "clay");
    bindNextMaterial(state, {});
    CHECK(state.material.empty());
}

TEST_CASE("scene state: a blend replaces what its parts had, and leaves the others theirs") {
    SceneState state;
    state.material = {{"gold", 1}, {"oak", 1}};
    bindBlend(state, {"gold", "clay"}, {{"clay", 0.5f}, {"gold", 0.25f}});
    CHECK(state.material == std::vector<WeightedMaterial>{{"oak", 1}, {"clay", 0.5f}, {"gold", 0.25f}});
    bindBlend(state, {"oak"}, {{"oak"}});
    CHECK(state.material.back().name == "oak");
    CHECK_EQ(state.material.size(), 3u);
}

TEST_CASE("scene state: terms are one at least, and all of them is 0") {
    SceneState state;
    addTerms(state, 1, 4);
    CHECK_EQ(state.terms, 0);
    for (const int expected : {3, 2, 1, 1}) {
        addTerms(state, -1, 4);
        CHECK_EQ(state.terms, expected);
    }
    addTerms(state, 3, 4);
    CHECK_EQ(state.terms, 0);
}
