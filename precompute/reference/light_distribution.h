// Directions drawn from a light cube, more often where it is brighter.
#pragma once

#include "engine/light/light_cube.h"

namespace relume {

class LightDistribution {
  public:
    // Takes a finite light, which may be negative in places: it is drawn by its magnitude there.
    explicit LightDistribution(const LightCube& light);

    bool isBlack() const { return mEnds.empty(); }

    struct Draw {
        vec3 direction; // unit
        size_t texel;   // that it passes through
    };
    // A texel in proportion to (|r| + |g| + |b|) · solid angle, and a direction through it, uniform over its
    // square on the face. All three numbers are uniform in [0, 1); texels come in order of `choice`. Not of a
    // black light.
    Draw draw(double choice, float across, float down) const;

    // How likely draw() is to give a unit direction through `texel`, in sr⁻¹.
    float density(vec3 direction, size_t texel) const;

    size_t texelOf(vec3 direction) const;
    vec3 radiance(size_t texel) const { return mTexels[texel].radiance; }

  private:
    struct Texel {
        vec3 radiance;
        float density = 0; // on its face, whose area is 4
    };
    int mSize; // texels a side
    std::vector<Texel> mTexels;
    std::vector<double> mEnds;    // per texel: the share of it and those before
    std::vector<uint32_t> mFirst; // the texel at choice i / size: where the search begins
};

} // namespace relume
