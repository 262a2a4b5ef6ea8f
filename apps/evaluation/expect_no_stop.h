// The wish of Ctrl-C, granted where steps may end.
#pragma once

namespace relume {

// Throws BakeStopped when an interrupt was caught.
void expectNoStop();

} // namespace relume
