// What the libraries say while it lives.
#pragma once

#include "engine/base/log.h"

namespace relume::test {

class LogCapture {
  public:
    LogCapture() {
        setLog([this](LogLevel, const std::string& text) { mText += text + '\n'; });
    }
    ~LogCapture() { setLog(nullptr); }
    LogCapture(const LogCapture&) = delete;
    LogCapture& operator=(const LogCapture&) = delete;

    const std::string& text() const { return mText; }
    bool says(const std::string& part) const { return mText.find(part) != std::string::npos; }

  private:
    std::string mText;
};

} // namespace relume::test
