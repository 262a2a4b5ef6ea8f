// A display that is not there: Xvfb, for as long as this lives.
#pragma once

#include <csignal>
#include <doctest/doctest.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace relume::test {

class Display {
  public:
    Display() {
        int numbers[2];
        REQUIRE_EQ(pipe(numbers), 0);
        mProcess = fork();
        if (mProcess == 0) {
            close(numbers[0]);
            const std::string to = std::to_string(numbers[1]);
            execlp("Xvfb", "Xvfb", "-displayfd", to.c_str(), "-screen", "0", "1600x1200x24", "-nolisten",
                   "tcp", nullptr);
            _exit(127);
        }
        close(numbers[1]);
        char digit;
        while (read(numbers[0], &digit, 1) == 1 && digit != '\n') mNumber += digit;
        close(numbers[0]);
        REQUIRE_MESSAGE(!mNumber.empty(), "Xvfb does not start; scripts/setup installs it");
    }
    ~Display() {
        kill(mProcess, SIGTERM);
        waitpid(mProcess, nullptr, 0);
    }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    // To be put before a command.
    std::string environment() const { return "DISPLAY=:" + mNumber; }

  private:
    pid_t mProcess = -1;
    std::string mNumber;
};

} // namespace relume::test
