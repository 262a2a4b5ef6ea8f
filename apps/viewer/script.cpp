#include "apps/viewer/script.h"

#include "apps/viewer/comparison.h"
#include "engine/base/error.h"
#include "engine/import/json_object.h"

#include <GLFW/glfw3.h>
#include <algorithm>
#include <fmt/core.h>
#include <map>
#include <set>

namespace relume {

namespace {

using nlohmann::json;

const std::map<std::string, int>& buttons() {
    static const std::map<std::string, int> all = {{"left", GLFW_MOUSE_BUTTON_LEFT},
                                                   {"middle", GLFW_MOUSE_BUTTON_MIDDLE},
                                                   {"right", GLFW_MOUSE_BUTTON_RIGHT}};
    return all;
}

// Splits text such as "shift+left" into the key or button and its modifiers.
std::pair<std::string, int> splitModifiers(std::string text) {
    int modifiers = 0;
    const std::pair<const char*, int> known[] = {{"shift+", GLFW_MOD_SHIFT}, {"ctrl+", GLFW_MOD_CONTROL}};
    for (bool found = true; found;) {
        found = false;
        for (const auto& [name, bit] : known)
            if (text.starts_with(name)) {
                text.erase(0, std::string(name).size());
                modifiers |= bit;
                found = true;
            }
    }
    return {text, modifiers};
}

// Returns the key of a name: a letter, a digit, a sign, F1 to F12, Enter, Escape, Space or Tab.
int keyOf(const std::string& name) {
    if (name.size() == 1 && name[0] >= 'A' && name[0] <= 'Z') return GLFW_KEY_A + (name[0] - 'A');
    if (name.size() == 1 && name[0] >= '0' && name[0] <= '9') return GLFW_KEY_0 + (name[0] - '0');
    for (int i = 1; i <= 12; i++)
        if (name == fmt::format("F{}", i)) return GLFW_KEY_F1 + i - 1;
    if (name == "-") return GLFW_KEY_MINUS;
    if (name == "=") return GLFW_KEY_EQUAL;
    if (name == "Enter") return GLFW_KEY_ENTER;
    if (name == "Escape") return GLFW_KEY_ESCAPE;
    if (name == "Space") return GLFW_KEY_SPACE;
    if (name == "Tab") return GLFW_KEY_TAB;
    throw Error(fmt::format(
        "expected a key, found \"{}\"; A to Z, 0 to 9, -, =, F1 to F12, Enter, Escape, Space and Tab are",
        name));
}

vec2 pairOf(const json& step, const char* name) {
    const json& value = step.at(name);
    return {value.at(0).get<float>(), value.at(1).get<float>()};
}

int wholeOf(const json& value, const char* name, int least, int most) {
    if (!value.is_number_integer() || value < least || value > most)
        throw Error(fmt::format("\"{}\": expected a whole number from {} to {}, found {}", name, least, most,
                                value.dump()));
    return value.get<int>();
}

void checkWait(const json& wait) {
    constexpr double kMostSeconds = 1e6;
    const bool isPasses = wait.is_object() && wait.size() == 1 && wait.contains("passes");
    if (isPasses)
        wholeOf(wait["passes"], "passes", 0, Comparison::kPasses);
    else if (wait != "settled" && wait != "shown" && !(wait.is_number() && wait >= 0 && wait <= kMostSeconds))
        throw Error(fmt::format(
            "\"wait\": expected \"settled\", \"shown\", 0 to {} seconds, or {{\"passes\": N}} of a "
            "comparison, found {}",
            kMostSeconds, wait.dump()));
}

// Throws unless a step is one action with valid parameters.
void checkStep(const json& step) {
    static const std::map<std::string, std::set<std::string>> kActions = {
        {"click", {}}, {"double-click", {}}, {"drag", {"from", "by", "over"}},
        {"drop", {}},  {"frames", {}},       {"key", {"at"}},
        {"quit", {}},  {"resize", {}},       {"screenshot", {}},
        {"set", {}},   {"wait", {}},         {"wheel", {"at"}}};
    if (!step.is_object()) throw Error(fmt::format("expected an object, found {}", step.dump()));
    const auto action =
        std::ranges::find_if(kActions, [&](const auto& known) { return step.contains(known.first); });
    if (action == kActions.end())
        throw Error(fmt::format(
            "expected one of click, double-click, drag, drop, frames, key, quit, resize, screenshot, "
            "set, wait, wheel; found {}",
            step.dump()));
    for (const auto& [key, value] : step.items())
        if (key != action->first && !action->second.contains(key))
            throw Error(fmt::format("\"{}\" is no part of \"{}\"; a step does one thing: make it two", key,
                                    action->first));
    constexpr int kMost = 1000000000;
    if (step.contains("frames")) wholeOf(step["frames"], "frames", 0, kMost);
    if (step.contains("over")) wholeOf(step["over"], "over", 1, kMost);
    if (step.contains("wait")) checkWait(step["wait"]);
    if (step.contains("resize")) {
        wholeOf(step["resize"].at(0), "resize", kSmallestWindow.x, kLargestWindow);
        wholeOf(step["resize"].at(1), "resize", kSmallestWindow.y, kLargestWindow);
    }
}

} // namespace

Script::Script(const std::filesystem::path& file) : mFile(file) {
    mSteps = readJson(file);
    if (!mSteps.is_array()) throw Error(fmt::format("{}: expected a JSON array of steps", file.string()));
    for (; !hasEnded(); mStep++) tellStep([&] { checkStep(mSteps[mStep]); });
    mStep = 0;
}

template <typename Work>
void Script::tellStep(const Work& work) {
    try {
        work();
    } catch (const json::exception& wrong) {
        throw Error(fmt::format("{}: step {}: {}", mFile.string(), mStep + 1, wrong.what()));
    } catch (const Error& wrong) {
        throw Error(fmt::format("{}: step {}: {}", mFile.string(), mStep + 1, wrong.what()));
    }
}

void Script::step(ScriptTarget& target) {
    while (!hasEnded()) {
        bool isOver = false;
        tellStep([&] { isOver = run(target, mSteps[mStep]); });
        if (!isOver) return;
        mStep++;
        mFrame = 0;
    }
}

bool Script::run(ScriptTarget& target, const json& step) {
    if (step.contains("drag")) return drag(target, step);
    const bool isFirst = mFrame++ == 0;
    if (step.contains("frames")) return mFrame > step["frames"].get<int>();
    if (step.contains("wait")) return hasWaited(target, step["wait"]);
    // The other actions take one frame: they run in the first, and the next step follows.
    if (!isFirst) return true;
    if (step.contains("set")) {
        for (const auto& [name, value] : step["set"].items()) target.set(name, value);
    } else if (step.contains("key")) {
        const auto [name, modifiers] = splitModifiers(step["key"].get<std::string>());
        if (step.contains("at")) target.input({InputEvent::Kind::Move, 0, false, 0, pairOf(step, "at")});
        for (const bool isDown : {true, false})
            target.input({InputEvent::Kind::Key, keyOf(name), isDown, modifiers});
    } else if (step.contains("click") || step.contains("double-click")) {
        const bool isDouble = step.contains("double-click");
        const vec2 place = pairOf(step, isDouble ? "double-click" : "click");
        target.input({InputEvent::Kind::Move, 0, false, 0, place});
        for (int i = 0; i < (isDouble ? 4 : 2); i++)
            target.input({InputEvent::Kind::Button, GLFW_MOUSE_BUTTON_LEFT, i % 2 == 0, 0, place});
    } else if (step.contains("wheel")) {
        if (step.contains("at")) target.input({InputEvent::Kind::Move, 0, false, 0, pairOf(step, "at")});
        target.input({InputEvent::Kind::Scroll, 0, false, 0, {0, step["wheel"].get<float>()}});
    } else if (step.contains("drop")) {
        InputEvent event{InputEvent::Kind::Drop};
        for (const json& file : step["drop"]) event.files.emplace_back(file.get<std::string>());
        target.input(std::move(event));
    } else if (step.contains("resize")) {
        const vec2 size = pairOf(step, "resize");
        target.resize(int(size.x), int(size.y));
    } else if (step.contains("screenshot")) {
        target.screenshot(step["screenshot"].get<std::string>());
    } else {
        target.quit();
    }
    return false;
}

// Returns whether all is settled, enough passes of the reference are done, or enough seconds have passed.
bool Script::hasWaited(const ScriptTarget& target, const json& wait) {
    if (mFrame == 1) mWaitsSince = std::chrono::steady_clock::now();
    if (wait == "settled") return target.isSettled();
    if (wait == "shown") return target.isShown();
    if (wait.is_number())
        return std::chrono::steady_clock::now() - mWaitsSince >=
               std::chrono::duration<double>(wait.get<double>());
    return target.comparedPasses() >= wait["passes"].get<int>();
}

// Presses at `from`, moves by an equal part of `by` in each of `over` frames, then releases.
bool Script::drag(ScriptTarget& target, const json& step) {
    const auto [name, modifiers] = splitModifiers(step["drag"].get<std::string>());
    const auto button = buttons().find(name);
    if (button == buttons().end())
        throw Error(fmt::format(
            "\"drag\": expected left, middle or right, after shift+ or ctrl+; found \"{}\"", name));
    const vec2 from = pairOf(step, "from"), by = pairOf(step, "by");
    const int frames = step.value("over", 1);
    using Kind = InputEvent::Kind;
    if (mFrame == 0) {
        target.input({Kind::Move, 0, false, 0, from});
        target.input({Kind::Button, button->second, true, modifiers, from});
    }
    if (mFrame < frames) {
        mFrame++;
        target.input({Kind::Move, 0, false, 0, from + float(mFrame) / float(frames) * by});
        return false;
    }
    target.input({Kind::Button, button->second, false, modifiers, from + by});
    return true;
}

} // namespace relume
