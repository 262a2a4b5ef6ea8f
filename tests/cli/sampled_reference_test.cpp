// Reference images by sampling: `relume reference --noise`.
#include "engine/import/image_file.h"
#include "tests/support/run_relume.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <doctest/doctest.h>
#include <fmt/core.h>
#include <thread>
#include <unistd.h>

using namespace relume;
using namespace relume::test;

namespace {

const TemporaryFolder& folder() {
    static const TemporaryFolder folder;
    if (!std::filesystem::exists(folder.path() / "a.relume"))
        REQUIRE_EQ(runRelume(folder, "bake " + ballIn(folder) +
                                         " --ground --ground-tessellation 4 -K 2 -N 32 --bounces 0 "
                                         "--visibility-size 64 --face-size 32 --map-size 16 -q -o a.relume")
                       .exitCode,
                   0);
    return folder;
}

Image draw(const std::string& options) {
    const Outcome outcome = runRelume(folder(), "reference a.relume --size 48x36 -o image.exr " + options);
    REQUIRE_MESSAGE(outcome.exitCode == 0, outcome.err);
    return readImage(folder().path() / "image.exr").image;
}

// Returns the RMS difference, relative to the RMS of `truth`.
double difference(const Image& image, const Image& truth) {
    double squares = 0, level = 0;
    for (size_t i = 0; i < truth.pixels.size(); i++) {
        const vec3 expected(truth.pixels[i]), missed = vec3(image.pixels[i]) - expected;
        squares += double(glm::dot(missed, missed));
        level += double(glm::dot(expected, expected));
    }
    return std::sqrt(squares / level);
}

} // namespace

TEST_CASE("sampled reference: is as near to the exact one as it says") {
    const Image exact = draw("--bounces 0");
    for (const double noise : {0.1, 0.02}) {
        const Image sampled = draw(fmt::format("--bounces 0 --noise {}", noise));
        const double found = difference(sampled, exact);
        CHECK_LT(found, 1.5 * noise);
        CHECK_GT(found, 0.05 * noise);
    }
    // The same passes give the same bytes.
    const std::string bytes = contents(folder().path() / "image.exr");
    draw("--bounces 0 --noise 0.02");
    CHECK(contents(folder().path() / "image.exr") == bytes);
}

TEST_CASE("sampled reference: options that it has no use for are refused") {
    for (const char* other : {"--rays 16", "--paths 8", "--occluder baked", "--brdf residual"}) {
        CAPTURE(other);
        const Outcome outcome =
            runRelume(folder(), std::string("reference a.relume -o x.exr --noise 0.1 ") + other);
        CHECK_EQ(outcome.exitCode, 2);
        CHECK(says(outcome.err, "--noise"));
    }
    for (const char* noise : {"0", "2", "nan"})
        CHECK_EQ(runRelume(folder(), std::string("reference a.relume -o x.exr --noise ") + noise).exitCode,
                 2);
}

TEST_CASE("sampled reference: Ctrl-C keeps the picture so far") {
    const std::string start = fmt::format("cd '{}' && exec '{}' reference a.relume --size 48x36 -o kept.png "
                                          "--noise 0.0001 >out.txt 2>err.txt </dev/null",
                                          folder().path().string(), RELUME_PROGRAM);
    const pid_t process = fork();
    REQUIRE_GE(process, 0);
    if (process == 0) {
        execl("/bin/sh", "sh", "-c", start.c_str(), nullptr);
        _exit(127);
    }
    const auto picture = folder().path() / "kept.png";
    for (int i = 0; i < 4000 && !std::filesystem::exists(picture); i++)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK(std::filesystem::exists(picture)); // after the first pass
    kill(process, SIGINT);
    int status = 0;
    REQUIRE_EQ(waitpid(process, &status, 0), process);
    REQUIRE(WIFEXITED(status));
    CHECK_EQ(WEXITSTATUS(status), 128 + SIGINT);
    const std::string words = contents(folder().path() / "err.txt");
    CHECK(says(words, "kept.png has the passes so far"));
    CHECK(says(words, "passes, with "));
}
