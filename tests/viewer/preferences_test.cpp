// What is remembered from one time to the next.
#include "apps/viewer/preferences.h"

#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <doctest/doctest.h>

using namespace relume;
using namespace relume::test;
using nlohmann::json;

namespace {

// A user's state folder of a test's own.
struct StateFolder {
    TemporaryFolder folder;
    std::filesystem::path file = folder.path() / "relume" / "viewer.json";

    StateFolder() { setenv("XDG_STATE_HOME", folder.path().c_str(), 1); }
    ~StateFolder() { unsetenv("XDG_STATE_HOME"); }

    Preferences read(const std::string& text) const {
        std::filesystem::create_directories(file.parent_path());
        writeFileAtomically(file, text);
        return readPreferences();
    }
};

void checkIsEmpty(const Preferences& preferences) {
    CHECK_FALSE(preferences.size);
    CHECK(preferences.recent.empty());
    CHECK(preferences.environments.empty());
    CHECK_EQ(preferences.settings, json::object());
}

} // namespace

TEST_CASE("preferences: are the same the next time") {
    const StateFolder state;
    checkIsEmpty(readPreferences());
    const auto bake = state.folder.write("a b.relume", "x"), map = state.folder.write("map.exr", "x");
    writePreferences({ivec2(800, 600), {bake, map}, {map}, {{"exposure", 1.5}, {"tone", "aces"}}});
    const Preferences preferences = readPreferences();
    CHECK_EQ(preferences.size, ivec2(800, 600));
    CHECK_EQ(preferences.recent, std::vector<std::filesystem::path>{bake, map});
    CHECK_EQ(preferences.environments, std::vector<std::filesystem::path>{map});
    CHECK_EQ(preferences.settings, json{{"exposure", 1.5}, {"tone", "aces"}});

    writePreferences({std::nullopt, {bake}, {}, {{"dark", false}}}); // a session in full screen
    const Preferences unsized = readPreferences();
    CHECK_FALSE(unsized.size);
    CHECK_EQ(unsized.recent.size(), 1u);
    CHECK_EQ(unsized.settings, json{{"dark", false}});

    std::filesystem::remove(bake);
    CHECK(readPreferences().recent.empty()); // what is gone is left out
}

TEST_CASE("preferences: what makes no sense is left out, and the rest is not") {
    const StateFolder state;
    for (const char* text : {"", "{", "[]", "3", "null", "\"x\"", "{\"width\": 800", "\xff\xfe"}) {
        CAPTURE(text);
        checkIsEmpty(state.read(text));
    }
    std::string deep(1 << 18, '[');
    deep = "{\"settings\": {\"x\": " + deep + std::string(deep.size(), ']') + "}}";
    checkIsEmpty(state.read(deep)); // that a copy or a print of it would take the stack for
    checkIsEmpty(state.read(std::string(2 << 20, ' ') + "{\"width\": 800, \"height\": 600}")); // absurd

    const std::string there = state.folder.write("there.relume", "x").string();
    const json whole = {{"width", 800},
                        {"height", 600},
                        {"recent", {there}},
                        {"environments", {there}},
                        {"settings", {{"dark", false}}}};
    for (const auto& [name, value] : whole.items())
        for (const json& wrong : {json(-1), json(1e30), json("x"), json(nullptr), json(true), json::object(),
                                  json::array({1, nullptr, "/nowhere", std::string(5000, 'x')})}) {
            if (name == "settings" && wrong.is_object()) continue;
            json damaged = whole;
            damaged[name] = wrong;
            CAPTURE(damaged.dump().substr(0, 300));
            const Preferences preferences = state.read(damaged.dump());
            CHECK_EQ(preferences.size.has_value(), name != "width" && name != "height");
            CHECK_EQ(preferences.recent.size(), name == "recent" ? 0u : 1u);
            CHECK_EQ(preferences.environments.size(), name == "environments" ? 0u : 1u);
            CHECK_EQ(preferences.settings.size(), name == "settings" ? 0u : 1u);
        }
    json many = whole;
    many["recent"] = std::vector<std::string>(500, there);
    CHECK_LE(state.read(many.dump()).recent.size(), 64u);
    for (const auto& [width, height] : {std::pair(100, 600), {800, 100}, {20000, 600}, {800, 20000}}) {
        json odd = whole;
        odd["width"] = width, odd["height"] = height;
        CHECK_FALSE(state.read(odd.dump()).size);
    }
}
