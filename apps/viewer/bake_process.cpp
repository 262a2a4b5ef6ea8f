#include "apps/viewer/bake_process.h"

#include "engine/base/error.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace relume {

namespace {

constexpr size_t kMostWords = 4096; // of its latest messages

std::filesystem::path findProgram() {
    std::error_code failure;
    const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", failure);
    const std::filesystem::path program = own.parent_path() / "relume";
    if (!std::filesystem::exists(program, failure))
        throw Error(
            fmt::format("{}: expected the program that bakes, found none; install it beside relume-viewer",
                        program.string()));
    return program;
}

// Reads what is available from a nonblocking pipe.
std::string readAll(int pipe) {
    std::string text;
    char buffer[4096];
    for (ssize_t count; pipe >= 0 && (count = read(pipe, buffer, sizeof buffer)) > 0;)
        text.append(buffer, size_t(count));
    return text;
}

} // namespace

BakeProcess::BakeProcess(const std::filesystem::path& input, const std::filesystem::path& output,
                         const std::vector<std::string>& options)
    : mInput(input), mOutput(output) {
    std::vector<std::string> words{findProgram(), "bake"};
    words.push_back(std::filesystem::absolute(input));
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--preview", "--json", "-o", output});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    int events[2], errors[2];
    if (pipe2(events, O_CLOEXEC) != 0)
        throw Error(fmt::format("a bake cannot be begun: {}", std::strerror(errno)));
    if (pipe2(errors, O_CLOEXEC) != 0) {
        const std::string why = std::strerror(errno);
        close(events[0]);
        close(events[1]);
        throw Error(fmt::format("a bake cannot be begun: {}", why));
    }
    mProcess = fork();
    if (mProcess == 0) {
        dup2(events[1], STDOUT_FILENO);
        dup2(errors[1], STDERR_FILENO);
        setpriority(PRIO_PROCESS, 0, 10); // frames go first; see comparison.cpp
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    const int failure = mProcess < 0 ? errno : 0;
    close(events[1]);
    close(errors[1]);
    if (failure != 0) {
        close(events[0]);
        close(errors[0]);
        throw Error(fmt::format("a bake cannot be begun: {}", std::strerror(failure)));
    }
    mEvents = events[0];
    mWords = errors[0];
    fcntl(mEvents, F_SETFL, O_NONBLOCK);
    fcntl(mWords, F_SETFL, O_NONBLOCK);
    mProgress.stage = "starting";
}

void BakeProcess::stop() {
    if (mProcess > 0) kill(mProcess, SIGTERM);
}

BakeProcess::~BakeProcess() {
    if (mProcess > 0) {
        stop();
        waitpid(mProcess, nullptr, 0);
    }
    end();
}

void BakeProcess::end() {
    if (mEvents >= 0) close(mEvents);
    if (mWords >= 0) close(mWords);
    mEvents = mWords = -1;
    mProcess = -1;
}

bool BakeProcess::poll() {
    if (mProcess <= 0) return false;
    int status = 0;
    const bool hasEnded = waitpid(mProcess, &status, WNOHANG) == mProcess; // before reading its last messages
    bool isThere = false;
    mSaid += readAll(mWords);
    if (mSaid.size() > kMostWords) mSaid.erase(0, mSaid.size() - kMostWords);
    mPartialEvent += readAll(mEvents);
    for (size_t line; (line = mPartialEvent.find('\n')) != std::string::npos;) {
        isThere |= take(mPartialEvent.substr(0, line));
        mPartialEvent.erase(0, line + 1);
    }
    if (!hasEnded) return isThere;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        const size_t error = mSaid.rfind("error: ");
        mFailure = error != std::string::npos ? mSaid.substr(error + 7) : "the bake ended without a word";
        while (!mFailure.empty() && mFailure.back() == '\n') mFailure.pop_back();
    }
    end();
    return isThere;
}

bool BakeProcess::take(const std::string& line) {
    const nlohmann::json event = nlohmann::json::parse(line, nullptr, false);
    if (!event.is_object()) return false;
    const std::string kind = event.value("event", "");
    if (kind == "stage") mProgress = {.stage = event.value("stage", "")};
    if (kind == "progress") {
        mProgress.fraction = event.value("fraction", 0.0);
        mProgress.secondsLeft = event.value("seconds_left", -1.0);
    }
    return kind == "preview" || kind == "done";
}

} // namespace relume
