#include "engine/base/interrupt.h"

#include <csignal>
#include <initializer_list>

namespace relume {

namespace {

volatile std::sig_atomic_t gCaught = 0;

void onSignal(int signal) {
    gCaught = signal;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

} // namespace

void catchInterrupts() {
    for (int signal : {SIGINT, SIGTERM}) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler == SIG_IGN) continue;
        action = {};
        action.sa_handler = onSignal;
        action.sa_flags = SA_RESTART;
        sigaction(signal, &action, nullptr);
    }
}

int caughtInterrupt() { return gCaught; }

} // namespace relume
