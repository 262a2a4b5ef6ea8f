// An isotropic BRDF as a table over half and difference angles (Rusinkiewicz, "A New Change of Variables for
// Efficient BRDF Representation", Eurographics Workshop on Rendering 1998). It is reciprocal, since φd covers
// half a turn only.
#pragma once

#include "engine/math/vector.h"

#include <array>
#include <cstddef>
#include <vector>

namespace relume {

struct HalfDifference {
    float half, difference; // θh and θd, 0 to π/2
    float azimuth;          // φd, 0 to π; the same for (ωi, ωo) and (ωo, ωi), to the bit
};

// Takes unit directions with z > 0.
HalfDifference halfDifference(vec3 incoming, vec3 outgoing);
// Returns one pair of directions with these angles; either may lie below the horizon.
std::array<vec3, 2> directionsOf(const HalfDifference& angles);

class IsotropicTable {
  public:
    // Takes the number of cells along θh (evenly spaced in √θh, so dense near the peak), θd and φd.
    IsotropicTable(int halves, int differences, int azimuths);

    int halves() const { return mHalves; }
    int differences() const { return mDifferences; }
    int azimuths() const { return mAzimuths; }
    size_t cellCount() const { return mValues.size(); }

    // Returns a cell's index; φd varies fastest, θh slowest.
    size_t cell(int half, int difference, int azimuth) const {
        return (size_t(half) * size_t(mDifferences) + size_t(difference)) * size_t(mAzimuths) +
               size_t(azimuth);
    }
    vec3& operator[](size_t cell) { return mValues[cell]; }
    const vec3& operator[](size_t cell) const { return mValues[cell]; }
    HalfDifference centerOf(int half, int difference, int azimuth) const;

    // Returns the value of the cell that contains a pair of directions.
    vec3 nearest(vec3 incoming, vec3 outgoing) const;
    // Interpolates linearly between the centers of the eight nearest cells.
    vec3 interpolate(vec3 incoming, vec3 outgoing) const;

  private:
    // Returns coordinates in units of cells; centers are at half-integers.
    vec3 place(vec3 incoming, vec3 outgoing) const;

    int mHalves, mDifferences, mAzimuths;
    std::vector<vec3> mValues;
};

} // namespace relume
