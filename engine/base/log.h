// Messages about what the library met and recovered from. What it cannot recover from is an Error.
#pragma once

#include <functional>
#include <string>

namespace relume {

enum class LogLevel { Debug, Info, Warning, Error };

using LogFunction = std::function<void(LogLevel level, const std::string& text)>;

// Sends all further messages to `function`, on whichever thread logs them. Without a function, as at first,
// messages are dropped. Not thread-safe: call it while nothing else of the library runs.
void setLog(LogFunction function);

void log(LogLevel level, const std::string& text);

} // namespace relume
