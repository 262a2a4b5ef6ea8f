// Ctrl-C and SIGTERM as a wish that long work can grant when it suits.
#pragma once

namespace relume {

// From now on the first SIGINT or SIGTERM only sets what caughtInterrupt() tells; a second one ends the
// process as ever. A signal that was ignored (nohup) stays so.
void catchInterrupts();

// The signal that came, 0 for none.
int caughtInterrupt();

} // namespace relume
