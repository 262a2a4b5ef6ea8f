// The rays along which a vertex gathers bounced light.
#pragma once

#include "engine/math/vector.h"

#include <cstddef>
#include <cstdint>

namespace relume {

// Cosine-distributed directions in a vertex's frame: kSide² strata of a square, mapped to the hemisphere and
// shifted differently for every vertex.
class BounceRays {
  public:
    static constexpr int kSide = 32;
    static constexpr float kWeight = kPi / (kSide * kSide); // cosine · solid angle that a ray stands for

    BounceRays(size_t part, uint32_t vertex);

    // Advances to the next ray; must be called before the first. Returns false after the last.
    bool next() { return ++mRay < kSide * kSide; }
    vec3 direction() const; // unit, in the frame
    // Returns a number in [0, 1), independent of the direction, for a random choice per ray.
    float choice() const;

  private:
    int mRay = -1;
    vec3 mShift; // of the square's axes, and of choice()
};

} // namespace relume
