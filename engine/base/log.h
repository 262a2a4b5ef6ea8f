// Words for people about what a library met and went on from; what it could not go on from is an Error.
#pragma once

#include <functional>
#include <string>

namespace relume {

enum class LogLevel { Debug, Info, Warning, Error };

using LogFunction = std::function<void(LogLevel level, const std::string& text)>;

// Hands every message from now on to `function`, on whichever thread it comes from; none: they are dropped,
// as they are until this is first called. Call it while nothing else of the library runs.
void setLog(LogFunction function);

void log(LogLevel level, const std::string& text);

} // namespace relume
