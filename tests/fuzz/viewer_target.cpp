// What the viewer reads. The first byte of an input chooses: 0: the rest is a script; 1: settings, as an
// object; 2: what it remembers from one time to the next; 3: a session of the bake a.relume, which may name
// the light file light.json.
#include "apps/viewer/opened_file.h"
#include "apps/viewer/preferences.h"
#include "apps/viewer/script.h"
#include "apps/viewer/session.h"
#include "apps/viewer/settings.h"
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "engine/import/light_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace relume::test {

namespace {

enum Kind { kScript, kSettings, kPreferences, kSession, kKinds };

std::filesystem::path write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

// The folder of all inputs.
const TemporaryFolder& folderOfInputs() {
    static const TemporaryFolder folder;
    [[maybe_unused]] static const bool isFilled = [&] {
        folder.write("a.relume", "a bake");
        folder.write("light.json", R"({"lamps": [{"azimuth": {"keys": [[0, 0], [4, 90]]}, "elevation": 30,
                                                  "radius": 5, "radiance": [4, 3, 2]}]})");
        return true;
    }();
    return folder;
}

SceneState shownState() {
    SceneState state;
    state.orbit = Orbit();
    state.light.environments = {{.kind = EnvironmentChoice::Kind::BuiltIn, .name = "sky"},
                                {.kind = EnvironmentChoice::Kind::DaySky, .name = "day sky"}};
    return state;
}

// Opens a session that the viewer wrote. If it is refused, that is a finding.
Session openWritten(const nlohmann::ordered_json& session) {
    const std::string text = session.dump();
    try {
        return readSession(write(folderOfInputs().path() / "written.session.json", text), shownState());
    } catch (const Error& refused) {
        throw std::logic_error(refused.what() + (": " + text));
    }
}

// Takes what a script does; applies its settings.
class Target : public ScriptTarget {
  public:
    void input(InputEvent) override {}
    void resize(int width, int height) override { RELUME_CHECK(width > 0 && height > 0); }
    void screenshot(const std::filesystem::path&) override {}
    void set(const std::string& name, const nlohmann::json& value) override {
        applySetting(mState, name, value, &mBounds);
    }
    bool isSettled() const override { return true; }
    bool isShown() const override { return true; }
    int comparedPasses() const override { return 3; }
    void quit() override {}

    SceneState& state() { return mState; }

  private:
    SceneState mState = shownState();
    Bounds mBounds{vec3(-1), vec3(1)};
};

void applyAll(Target& target, const nlohmann::json& settings) {
    if (!settings.is_object()) return;
    for (const auto& [name, value] : settings.items()) {
        try {
            target.set(name, value);
        } catch (const Error&) {
        }
    }
    // What they are can be kept, and set again: an exception here is a finding.
    const nlohmann::json kept = rememberedSettings(target.state());
    for (const auto& [name, value] : kept.items()) target.set(name, value);
    const SceneState& state = target.state();
    const Session session =
        openWritten(sessionOf(state, state.ground, folderOfInputs().path() / "a.relume", "", {640, 480}));
    RELUME_CHECK_EQ(session.material.size(), state.material.size());
}

// Returns a session as the viewer writes it once it has opened one.
nlohmann::ordered_json writtenAgain(const Session& session) {
    SceneState state = session.state;
    state.orbit = orbitOf(session.camera);
    state.material = session.material;
    return sessionOf(state, state.ground, session.opened, "", {640, 480});
}

void runSession(const std::filesystem::path& folder, const std::string& text) {
    const std::filesystem::path file = write(folder / "a.session.json", text);
    if (kindOf(file) != FileKind::Session) return;
    const Session session = readSession(file, shownState());
    // It can be kept, and opened again: an exception here is a finding.
    const Session again = openWritten(writtenAgain(session));
    RELUME_CHECK_EQ(again.material.size(), session.material.size());
    RELUME_CHECK_EQ(again.state.light.lamps.size(), session.state.light.lamps.size());
    RELUME_CHECK_EQ(again.state.light.strokes.size(), session.state.light.strokes.size());
    RELUME_CHECK(again.opened == session.opened);
}

void run(std::span<const std::byte> input) {
    const TemporaryFolder& folder = folderOfInputs();
    constexpr int kMostFrames = 50;
    const int kind = input.empty() ? kScript : int(input[0]) % kKinds;
    const std::string text(textOf(input.subspan(std::min<size_t>(input.size(), 1))));
    Target target;
    try {
        if (kind == kScript) {
            Script script(write(folder.path() / "script.json", text));
            for (int frame = 0; frame < kMostFrames && !script.hasEnded(); frame++) script.step(target);
        } else if (kind == kSettings) {
            applyAll(target, nlohmann::json::parse(text, nullptr, false));
        } else if (kind == kSession) {
            runSession(folder.path(), text);
        } else {
            setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
            std::filesystem::create_directories(folder.path() / "relume");
            write(folder.path() / "relume/viewer.json", text);
            const Preferences preferences = readPreferences();
            unsetenv("XDG_STATE_HOME");
            applyAll(target, preferences.settings);
        }
    } catch (const Error&) {
    }
}

// Sessions as the viewer writes them, with names that are the same in every process.
std::vector<Bytes> sessionSeeds() {
    const std::filesystem::path& folder = folderOfInputs().path();
    SceneState plain = shownState();
    SceneState rich = plain;
    rich.material = {{"oak=dark", 0.25f}, {"gold", 0.75f}};
    rich.light.lamps = {LampChoice(), {.azimuth = -20, .radius = 30, .brightness = 2}};
    rich.light.strokes = {{.elevation = 9, .opacity = 0.5f}};
    rich.light.environmentGain = 0.5f;
    rich.light.rotation = 33;
    rich.light.selection = {.threshold = 64};
    rich.samples = 8;
    rich.terms = 3;
    rich.addsResidual = false;
    rich.backgroundBlur = 5;
    rich.ground = GroundStyle::Fade;
    SceneState day = plain;
    day.light.environment = 1;
    day.background = BackgroundKind::None;
    SceneState room = plain;
    room.light.environment = addEnvironment(room.light, "room.exr");
    room.material = {{"clay"}};
    SceneState moving = plain;
    moving.light.fileName = folder / "light.json";
    moving.light.file = std::make_shared<MovingLight>(readLight(moving.light.fileName));
    moving.light.seconds = 2.5;
    std::vector<Bytes> seeds;
    for (const SceneState& state : {plain, rich, day, room, moving}) {
        auto session = sessionOf(state, state.ground, folder / "a.relume", "", {640, 480});
        session["bake"] = "a.relume";
        if (state.light.file) session["light"] = "light.json";
        if (session.contains("environment")) session["environment"] = "room.exr";
        seeds.push_back(seedOf({kSession}, session.dump(1)));
    }
    return seeds;
}

std::vector<Bytes> seeds() {
    const char* const settings =
        R"({"azimuth": 30, "distance": 3, "exposure": "auto", "tone": "aces", "samples": 8, "coefficients": 100,
            "material": {"clay": 1, "gold": 2}, "lamps": [{"azimuth": 3, "color": [1, 0.5, 0.25], "radius": 9}],
            "strokes": [{"elevation": 9, "radiance": [1, 2, 3], "opacity": 0.5}], "day-sky": {"hour": 9}})";
    std::vector<Bytes> all = sessionSeeds();
    const Bytes others[] = {
        seedOf({kScript},
               R"([{"wait": "settled"}, {"set": {"terms": 3, "split": 0.25}}, {"wheel": 3, "at": [3, 4]},
                {"drag": "shift+left", "from": [30, 20], "by": [9, -4], "over": 3}, {"resize": [400, 300]},
                {"key": "ctrl+S"}, {"double-click": [3, 4]}, {"drop": ["a.obj"]}, {"frames": 2},
                {"wait": {"passes": 2}}, {"screenshot": "a.png"}, {"quit": true}])"),
        seedOf({kSettings}, settings),
        seedOf({kPreferences},
               std::string(R"({"width": 640, "height": 480, "recent": ["/"], "environments": [],
                "settings": )") +
                   settings + "}")};
    all.insert(all.end(), std::begin(others), std::end(others));
    return all;
}

const AddFuzzTarget kAdded({"viewer", run, seeds});

} // namespace
} // namespace relume::test
