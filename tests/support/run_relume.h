// Runs `relume` in a folder of a test's own.
#pragma once

#include "engine/import/builtin_mesh.h"
#include "tests/support/failure.h"
#include "tests/support/mesh_samples.h"
#include "tests/support/temporary_folder.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>

namespace relume::test {

// Environment in which lavapipe runs shaders in the thread that asks for it, so that file calls come in one
// order.
constexpr const char* kNoThreads = "LP_NUM_THREADS=0";

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream stream;
    stream << file.rdbuf();
    return stream.str();
}

// Returns how many calls apart a test lets one fail: `stride`, or 1 if RELUME_EVERY_FAULT is set.
inline int faultStride(int stride) { return std::getenv("RELUME_EVERY_FAULT") ? 1 : stride; }

struct Outcome {
    int exitCode; // 128 + the signal that ended it, as a shell says
    std::string out, err;
};

// Runs `PROGRAM ARGUMENTS` in a shell inside the folder; `environment` is put before it.
inline Outcome runProgram(const TemporaryFolder& folder, const std::string& program,
                          const std::string& arguments, const std::string& environment = "") {
    const std::string command = "cd '" + folder.path().string() + "' && " + environment + " '" + program +
                                "' " + arguments + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            contents(folder.path() / "out.txt"), contents(folder.path() / "err.txt")};
}

inline Outcome runRelume(const TemporaryFolder& folder, const std::string& arguments,
                         const std::string& environment = "") {
    return runProgram(folder, RELUME_PROGRAM, arguments, environment);
}

// Runs a command of relume that must succeed.
inline Outcome succeed(const TemporaryFolder& folder, const std::string& arguments) {
    const Outcome outcome = runRelume(folder, arguments, kNoThreads);
    REQUIRE_MESSAGE(outcome.exitCode == 0, arguments << ": " << outcome.err);
    return outcome;
}

// A folder with a mesh of one triangle.
struct BakeFolder : TemporaryFolder {
    BakeFolder() { write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"); }
};

// Writes a ball of 162 vertices to the folder and returns the arguments with which `relume bake` takes it
// unrefined.
inline std::string ballIn(const TemporaryFolder& folder) {
    if (!std::filesystem::exists(folder.path() / "ball.obj"))
        folder.write("ball.obj", sampleObj(makeSphere(2)));
    return "ball.obj --refine off";
}

} // namespace relume::test
