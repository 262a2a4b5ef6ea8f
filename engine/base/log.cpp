#include "engine/base/log.h"

#include <utility>

namespace relume {

static LogFunction logFunction;

void setLog(LogFunction function) { logFunction = std::move(function); }

void log(LogLevel level, const std::string& text) {
    if (logFunction) logFunction(level, text);
}

} // namespace relume
