// Repairs to tables of measured BRDFs.
#pragma once

#include "precompute/brdf/isotropic_table.h"

namespace relume {

// Gives every cell of `isMissing` (one entry per cell, not all true) the mean of its neighbors that have a
// value, from the edge of what is missing inwards.
void fillMissing(IsotropicTable& table, std::vector<bool> isMissing);

// Measurements of directions beyond some 80 degrees from the normal are dominated by noise. There, f
// max(cosθi, cosθo) (what a mirror's reflectance is in the model of Ashikhmin and Shirley) is held to 2.6
// times its value at the last cell of the same θh and φd within 80 degrees: Fresnel's term of index 1.5 rises
// by that much from 80 to 90 degrees.
struct GrazingRepair {
    size_t cells = 0;   // above the horizon and beyond 80 degrees
    size_t lowered = 0; // of these, in at least one channel
};
GrazingRepair limitGrazing(IsotropicTable& table);

} // namespace relume
