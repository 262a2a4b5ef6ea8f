#include "apps/evaluation/expect_no_stop.h"

#include "engine/base/interrupt.h"
#include "precompute/bake/bake_observer.h"

namespace relume {

void expectNoStop() {
    if (caughtInterrupt() != 0) throw BakeStopped("stopped");
}

} // namespace relume
