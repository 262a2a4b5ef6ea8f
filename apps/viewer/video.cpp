#include "apps/viewer/video.h"

#include "engine/base/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace relume {

namespace {

struct Outcome {
    int failure = 0; // to start the program: an errno
    int status = 0;  // of its end
    std::string said;
};

// Runs a program of $PATH without input and returns what it wrote to standard error.
Outcome runQuietly(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    Outcome outcome;
    int errors[2];
    if (pipe2(errors, O_CLOEXEC) != 0) return {.failure = errno};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, errors[1], STDERR_FILENO);
    pid_t process = -1;
    outcome.failure = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(errors[1]);
    char buffer[4096];
    for (ssize_t count; outcome.failure == 0 && (count = read(errors[0], buffer, sizeof buffer)) > 0;)
        outcome.said.append(buffer, size_t(count));
    close(errors[0]);
    if (outcome.failure != 0) return outcome;
    int status = 0;
    waitpid(process, &status, 0);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome;
}

} // namespace

std::optional<std::filesystem::path> encodeVideo(const std::filesystem::path& folder,
                                                 double framesPerSecond) {
    const std::filesystem::path video = folder.string() + ".mp4", unfinished = folder / "unfinished.mp4";
    const Outcome outcome =
        runQuietly({"ffmpeg", "-loglevel", "error", "-y", "-framerate", fmt::format("{}", framesPerSecond),
                    "-i", folder / "frame_%04d.png", "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v",
                    "libx264", "-crf", "16", "-pix_fmt", "yuv420p", "-movflags", "+faststart", unfinished});
    if (outcome.failure == ENOENT) return std::nullopt;
    std::error_code failure;
    if (outcome.failure == 0 && outcome.status == 0) {
        std::filesystem::rename(unfinished, video, failure);
        if (!failure) return video;
        throw Error(fmt::format("{}: cannot be written: {}", video.string(), failure.message()));
    }
    std::filesystem::remove(unfinished, failure);
    if (outcome.failure != 0)
        throw Error(
            fmt::format("{}: ffmpeg cannot be started: {}", video.string(), std::strerror(outcome.failure)));
    throw Error(fmt::format("{}: ffmpeg failed with exit status {}: {}", video.string(), outcome.status,
                            outcome.said));
}

} // namespace relume
