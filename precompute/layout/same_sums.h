// Products of matrices that are summed in the same order on every machine.
#pragma once

namespace relume {

// Eigen cuts products by the sizes of the caches it finds, and sums would differ from one machine to another.
// For all that follow, in the whole process; not while others multiply.
void sumAlikeEverywhere();

} // namespace relume
