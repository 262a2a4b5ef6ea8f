// Sessions of relume-viewer, replayed on a display that is not there.
#pragma once

#include "engine/import/builtin_mesh.h"
#include "engine/import/image_file.h"
#include "tests/support/display.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/run_relume.h"
#include "tests/support/validation.h"

#include <nlohmann/json.hpp>
#include <unistd.h>

namespace relume::test {

constexpr int kSessionWidth = 480, kSessionHeight = 360;

// A folder with a mesh ring.obj, a bake ring.relume of it in two materials of one set, an environment
// room.exr, and the files that sessions leave there.
class ViewerSession {
  public:
    ViewerSession() {
        std::ofstream(path("ring.obj")) << sampleObj(makeTorus(1, 0.4f, 24, 12));
        Image room(64, 32);
        for (int y = 0; y < room.height; y++)
            for (int x = 0; x < room.width; x++) {
                const bool isWindow = x > 20 && x < 28 && y > 8 && y < 14;
                room.at(x, y) =
                    isWindow ? vec4(30, 28, 24, 1) : vec4(vec3(0.2f, 0.3f, 0.4f) * (1.0f - y / 40.0f), 1);
            }
        writeExr(path("room.exr"), room);
        bakeRing();
    }

    // ring.obj on a ground, in a second or two.
    void bake(const std::string& file, const std::string& options) {
        const Outcome bake = relume("bake ring.obj --ground --ground-tessellation 8 --refine off -K 4 -N 192 "
                                    "--bounces 0 --visibility-size 64 "
                                    "--face-size 32 --map-size 16 -q -o " +
                                    file + " " + options);
        REQUIRE_MESSAGE(bake.exitCode == 0, bake.err);
    }

    // A window of kSessionWidth × kSessionHeight, under validation. `environment` is put before the command.
    // The viewer's own caches are this session's; the driver's is shared, since it only saves compiling
    // shaders.
    Outcome replay(const nlohmann::json& script, const std::string& arguments,
                   const std::string& environment = "") {
        std::ofstream(path("script.json")) << script;
        return view("--script script.json --validation " + testValidation() + " " + arguments, environment);
    }
    Outcome view(const std::string& arguments, const std::string& environment = "") {
        return runProgram(mFolder, RELUME_VIEWER,
                          "--size " + std::to_string(kSessionWidth) + "x" + std::to_string(kSessionHeight) +
                              " " + arguments,
                          mDisplay.environment() + " XDG_CACHE_HOME=" + path("cache").string() +
                              " XDG_STATE_HOME=" + path("state").string() +
                              " MESA_SHADER_CACHE_DIR=\"${HOME:-/tmp}/.cache\""
                              " " +
                              kNoThreads + " timeout " + (std::getenv("RELUME_SOAK") ? "6h" : "300") +
                              " env " + environment);
    }
    Outcome relume(const std::string& arguments) { return runRelume(mFolder, arguments, kNoThreads); }

    std::filesystem::path path(const std::string& file) const { return mFolder.path() / file; }
    std::string bytes(const std::string& file) const { return contents(path(file)); }
    const TemporaryFolder& folder() const { return mFolder; }
    const Display& display() const { return mDisplay; }

  private:
    // Bakes ring.relume, or takes what another test has baked since these programs were built.
    void bakeRing() {
        const std::filesystem::path kept = std::filesystem::path(RELUME_TEST_BAKES) / "ring.relume";
        const auto isNewerThan = [&](const char* program) {
            return last_write_time(kept) > std::filesystem::last_write_time(program);
        };
        if (exists(kept) && isNewerThan(RELUME_PROGRAM) && isNewerThan("/proc/self/exe")) {
            copy_file(kept, path("ring.relume"));
            return;
        }
        bake("ring.relume", R"(-m '{"set": ["gold", "clay"]}')");
        create_directories(kept.parent_path());
        const std::filesystem::path whole = kept.string() + "." + std::to_string(getpid());
        copy_file(path("ring.relume"), whole);
        rename(whole, kept);
    }

    TemporaryFolder mFolder;
    Display mDisplay;
};

// One for all tests of a program that change nothing of what it holds.
inline ViewerSession& sharedSession() {
    static ViewerSession session;
    return session;
}

// What the viewer says draws the same as its screenshot `file`; empty: it said nothing.
inline std::string renderCommand(const std::string& words, const std::string& file) {
    const size_t written = words.find(file + " is written");
    REQUIRE_MESSAGE(written != std::string::npos, file);
    const std::string mark = "the same: relume ";
    const size_t line = words.rfind('\n', written), start = words.rfind(mark, written);
    if (line == std::string::npos || start == std::string::npos) return "";
    const size_t end = words.find('\n', start);
    return end == line ? words.substr(start + mark.size(), end - start - mark.size()) : "";
}

// Neither validation nor anything else has complained.
inline bool isQuiet(const std::string& words) { return !says(words, "validation:") && !says(words, "error"); }

// Big-endian, after the signature and the name of the first chunk.
inline std::pair<int, int> pngSize(const std::string& bytes) {
    REQUIRE_GE(bytes.size(), 24u);
    const auto word = [&](size_t at) {
        int value = 0;
        for (size_t i = 0; i < 4; i++) value = value << 8 | uint8_t(bytes[at + i]);
        return value;
    };
    return {word(16), word(20)};
}

} // namespace relume::test
