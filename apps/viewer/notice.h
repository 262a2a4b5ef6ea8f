// The last message to the user, shown at the window's lower edge and written to the terminal.
#pragma once

#include "engine/base/error_message.h"

#include <chrono>
#include <string>

namespace relume {

class Notice {
  public:
    // Replaces the message.
    void tell(const std::string& words, bool isFailure = false);
    void clear();

    // Clears good news after eight seconds; failures stay. Returns whether what is shown has changed since
    // the last call.
    bool update();
    bool hasNews() const { return mHasNews; }

    const std::string& words() const { return mWords; } // empty: nothing is shown
    bool isFailure() const { return mIsFailure; }

  private:
    std::string mWords;
    std::chrono::steady_clock::time_point mTime;
    bool mIsFailure = false, mHasNews = false;
};

// Runs `work` and tells the message of an exception that it throws.
template <typename Work>
void attempt(Notice& notice, Work work) {
    try {
        work();
    } catch (const std::exception& why) {
        notice.tell(errorMessage(why), true);
    }
}

} // namespace relume
