#include "apps/viewer/video.h"

#include "engine/base/error.h"

#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace relume {

namespace {

// Runs a program without input; returns its exit status and what it wrote to standard error.
std::pair<int, std::string> runQuietly(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    int errors[2];
    if (pipe2(errors, O_CLOEXEC) != 0) return {127, std::strerror(errno)};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, errors[1], STDERR_FILENO);
    pid_t process = -1;
    const int failure = posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(errors[1]);
    std::string said;
    char buffer[4096];
    for (ssize_t count; failure == 0 && (count = read(errors[0], buffer, sizeof buffer)) > 0;)
        said.append(buffer, size_t(count));
    close(errors[0]);
    if (failure != 0) return {127, std::strerror(failure)};
    int status = 0;
    waitpid(process, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, said};
}

} // namespace

std::optional<std::filesystem::path> findFfmpeg() {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path program = std::filesystem::path(folder) / "ffmpeg";
        if (!folder.empty() && access(program.c_str(), X_OK) == 0) return program;
    }
    return std::nullopt;
}

void encodeVideo(const std::filesystem::path& ffmpeg, const std::filesystem::path& folder,
                 double framesPerSecond, const std::filesystem::path& video) {
    const auto [status, said] =
        runQuietly({ffmpeg, "-loglevel", "error", "-n", "-framerate", fmt::format("{}", framesPerSecond),
                    "-i", folder / "frame_%04d.png", "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v",
                    "libx264", "-crf", "16", "-pix_fmt", "yuv420p", "-movflags", "+faststart", video});
    if (status == 0) return;
    std::error_code failure;
    std::filesystem::remove(video, failure);
    throw Error(fmt::format("{}: ffmpeg could not make it (status {}): {}", video.string(), status, said));
}

} // namespace relume
