// What the viewer reads. The first byte of an input chooses: 0: the rest is a script; 1: settings, as an
// object; 2: what it remembers from one time to the next.
#include "apps/viewer/preferences.h"
#include "apps/viewer/script.h"
#include "apps/viewer/settings.h"
#include "engine/base/check.h"
#include "engine/base/error.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <fstream>

namespace relume::test {

namespace {

enum Kind { kScript, kSettings, kPreferences, kKinds };

// Takes what a script does; applies its settings.
class Target : public ScriptTarget {
  public:
    Target() { mState.orbit = Orbit(); }

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
    SceneState mState;
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
}

std::filesystem::path write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

void run(std::span<const std::byte> input) {
    static const TemporaryFolder folder;
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

std::vector<Bytes> seeds() {
    const char* const settings =
        R"({"azimuth": 30, "distance": 3, "exposure": "auto", "tone": "aces", "samples": 8, "coefficients": 100,
            "material": {"clay": 1, "gold": 2}, "lamps": [{"azimuth": 3, "color": [1, 0.5, 0.25], "radius": 9}],
            "strokes": [{"elevation": 9, "radiance": [1, 2, 3], "opacity": 0.5}], "day-sky": {"hour": 9}})";
    return {seedOf({kScript},
                   R"([{"wait": "settled"}, {"set": {"terms": 3, "split": 0.25}}, {"wheel": 3, "at": [3, 4]},
                {"drag": "shift+left", "from": [30, 20], "by": [9, -4], "over": 3}, {"resize": [400, 300]},
                {"key": "ctrl+S"}, {"double-click": [3, 4]}, {"drop": ["a.obj"]}, {"frames": 2},
                {"wait": {"passes": 2}}, {"screenshot": "a.png"}, {"quit": true}])"),
            seedOf({kSettings}, settings),
            seedOf({kPreferences},
                   std::string(R"({"width": 640, "height": 480, "recent": ["/"], "environments": [],
                "settings": )") +
                       settings + "}")};
}

const AddFuzzTarget kAdded({"viewer", run, seeds});

} // namespace
} // namespace relume::test
