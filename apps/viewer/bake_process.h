// A bake beside the window: `relume bake`, in a process of its own, so that neither its work nor its failure
// is the window's.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace relume {

// What can be told of a bake in hand.
struct BakeProgress {
    std::string stage;
    double fraction = 0;
    double secondsLeft = -1; // below 0: not known yet

    bool operator==(const BakeProgress&) const = default;
};

class BakeProcess {
  public:
    // Begins a bake of `input` to `output`, previews first. `options` are
    // `relume bake`'s. Throws Error when the program `relume` is not beside this one.
    BakeProcess(const std::filesystem::path& input, const std::filesystem::path& output,
                const std::vector<std::string>& options);
    // Stops it, and waits for that; what it baked is kept for the next time.
    ~BakeProcess();
    BakeProcess(const BakeProcess&) = delete;
    BakeProcess& operator=(const BakeProcess&) = delete;

    // Reads what the bake has said since; never waits. True: the output is there anew.
    bool poll();

    // Asks it to end; what it baked is kept. It still runs until a poll() after that finds it ended.
    void stop();

    const std::filesystem::path& input() const { return mInput; }
    const std::filesystem::path& output() const { return mOutput; }
    const BakeProgress& progress() const { return mProgress; }
    bool isRunning() const { return mProcess > 0; }
    // Why it failed; empty if it did not.
    const std::string& failure() const { return mFailure; }

  private:
    bool take(const std::string& line);
    void end();

    std::filesystem::path mInput, mOutput;
    pid_t mProcess = -1;
    int mEvents = -1, mWords = -1; // its standard output, and error
    std::string mPartialEvent, mSaid;
    BakeProgress mProgress;
    std::string mFailure;
};

} // namespace relume
