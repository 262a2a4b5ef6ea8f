// Importance sampling of a light cube.
#pragma once

#include "engine/light/light_cube.h"

namespace relume {

class LightDistribution {
  public:
    // Takes a finite light. Where it is negative, sampling uses its magnitude.
    explicit LightDistribution(const LightCube& light);

    bool isBlack() const { return mEnds.empty(); }

    struct Draw {
        vec3 direction; // unit
        size_t texel;   // that contains it
    };
    // Draws a texel in proportion to (|r| + |g| + |b|) · solid angle, and a direction through it, uniform
    // over its square on the face. All arguments are uniform in [0, 1); texels ascend with `choice`. The
    // light must not be black.
    Draw draw(double choice, float across, float down) const;

    // Returns the density, in sr⁻¹, with which draw() yields a unit direction through `texel`.
    float density(vec3 direction, size_t texel) const;

    // Returns the texel that contains a direction.
    size_t texelOf(vec3 direction) const;
    vec3 radiance(size_t texel) const { return mTexels[texel].radiance; }

  private:
    struct Texel {
        vec3 radiance;
        float density = 0; // per area on its face, whose area is 4
    };
    int mSize; // texels per side of a face
    std::vector<Texel> mTexels;
    std::vector<double> mEnds;    // per texel: cumulative share
    std::vector<uint32_t> mFirst; // per i: the texel at choice i / size, where the search begins
};

} // namespace relume
