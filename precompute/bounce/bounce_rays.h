// The rays by which a vertex looks for surfaces that light it.
#pragma once

#include "engine/math/vector.h"

#include <cstddef>
#include <cstdint>

namespace relume {

// Directions above the horizon of a vertex's frame, as many per solid angle as its cosine counts: a square of
// kSide² strata, mapped to the hemisphere, and shifted differently for every vertex.
class BounceRays {
  public:
    static constexpr int kSide = 32;
    static constexpr float kWeight = kPi / (kSide * kSide); // cosine · solid angle of a ray

    BounceRays(size_t part, uint32_t vertex);

    bool next() { return ++mRay < kSide * kSide; }
    vec3 direction() const; // unit, in the frame
    // A number in [0, 1) that has nothing to do with the direction.
    float choice() const;

  private:
    int mRay = -1;
    vec3 mShift; // of the square's axes, and of choices
};

} // namespace relume
