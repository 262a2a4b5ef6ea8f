// Undo and redo.
#include "apps/viewer/history.h"

#include <doctest/doctest.h>

using namespace relume;

TEST_CASE("history: steps are taken back and again, and a new one ends what was taken back") {
    SceneState state;
    state.light.environments.resize(2);
    History history;
    history.keep(state);
    CHECK_FALSE(history.undo(state));
    state.light.lamps.emplace_back();
    history.keep(state);
    state.light.lamps[0].azimuth = 10;
    history.keep(state);
    state.material = {{"gold"}};
    state.light.environment = 1; // with the material before: one step

    CHECK(history.undo(state)); // keeps what was edited since
    CHECK(state.material.empty());
    CHECK_EQ(state.light.environment, 0u);
    CHECK_EQ(state.light.lamps.at(0).azimuth, 10);
    CHECK(history.undo(state));
    CHECK_EQ(state.light.lamps.at(0).azimuth, LampChoice().azimuth);
    CHECK(history.redo(state));
    CHECK_EQ(state.light.lamps.at(0).azimuth, 10);
    state.light.lamps.clear();
    history.keep(state);
    CHECK_FALSE(history.redo(state)); // gold is gone
    CHECK(history.undo(state));
    CHECK(history.undo(state));
    CHECK(history.undo(state));
    CHECK(state.light.lamps.empty());
    CHECK_FALSE(history.undo(state));
}

TEST_CASE("history: the camera, panels and what comes by itself are no edits") {
    SceneState state;
    state.orbit = Orbit{.distance = 5};
    History history;
    history.keep(state);
    state.orbit->azimuth = 1;
    state.showsPanels = false;
    state.exposure = 3; // found for the object
    history.keep(state);
    CHECK_FALSE(history.undo(state));

    state.exposesItself = false;
    state.exposure = 1;
    history.keep(state);
    state.exposure = 2;
    CHECK(history.undo(state));
    CHECK_EQ(state.exposure, 1);
    CHECK(history.undo(state));
    CHECK(state.exposesItself);
    CHECK(state.wantsExposure); // found anew
    CHECK_EQ(state.orbit->azimuth, 1);
    CHECK_FALSE(state.showsPanels);
}
