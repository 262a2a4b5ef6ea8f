// Repairs tables of measured BRDFs.
#pragma once

#include "precompute/brdf/isotropic_table.h"

namespace relume {

// Fills the cells in `isMissing` (one entry per cell, not all true) with the mean of their neighbors that
// have values, from the edge of each hole inwards.
void fillMissing(IsotropicTable& table, std::vector<bool> isMissing);

// Counts of limitGrazing(). Measurements beyond some 80 degrees from the normal are dominated by noise. There
// it limits f max(cosθi, cosθo), the reflectance of a mirror in the model of Ashikhmin and Shirley, to 2.6
// times its value at the last cell within 80 degrees that has the same θh and φd: the rise of the Fresnel
// term of index 1.5 from 80 to 90 degrees.
struct GrazingRepair {
    size_t cells = 0;   // above the horizon and beyond 80 degrees
    size_t lowered = 0; // of these, lowered in at least one channel
};
GrazingRepair limitGrazing(IsotropicTable& table);

} // namespace relume
