#include "engine/base/log.h"

#include <memory>
#include <mutex>
#include <utility>

namespace relume {

static std::mutex logMutex;
static std::shared_ptr<const LogFunction> logFunction; // threads that call it keep it

void setLog(LogFunction function) {
    auto kept = function ? std::make_shared<const LogFunction>(std::move(function)) : nullptr;
    const std::lock_guard lock(logMutex);
    logFunction.swap(kept);
}

void log(LogLevel level, const std::string& text) {
    std::shared_ptr<const LogFunction> function;
    {
        const std::lock_guard lock(logMutex);
        function = logFunction;
    }
    if (function) (*function)(level, text);
}

} // namespace relume
