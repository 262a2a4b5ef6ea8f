// Ctrl-C and SIGTERM as a request, which long work honors when it can stop safely.
#pragma once

namespace relume {

// Makes the first SIGINT or SIGTERM only set the result of caughtInterrupt(); a second one ends the process
// as usual. A signal that was ignored (as with nohup) stays ignored.
void catchInterrupts();

// Returns the signal that was caught, or 0.
int caughtInterrupt();

} // namespace relume
