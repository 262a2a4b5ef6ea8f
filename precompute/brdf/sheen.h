// The sheen of cloth: fibers that stand on a surface and shine at grazing angles.
#pragma once

#include "engine/math/vector.h"

#include <array>

namespace relume {

// KHR_materials_sheen: the distribution and the visibility of Estevez and Kulla, "Production Friendly
// Microfacet Sheen BRDF", SIGGRAPH 2017, of width α = max(roughness², .02). Directions are in the local
// frame, lifted above the horizon.
class Sheen {
  public:
    // `color`: in [0, 1], as `roughness`. A black sheen reflects nothing and hides nothing.
    Sheen(vec3 color, float roughness);

    // Returns f in sr⁻¹; `half` is the unit half vector. The formulas of narrow sheens (roughness below .3)
    // reflect up to 1.6 times what they receive at grazing angles; these are divided by the larger albedo of
    // the two directions.
    vec3 evaluate(vec3 wi, vec3 wo, vec3 half) const;

    // Returns the factor on what lies below: 1 less the largest channel's albedo, in the direction where that
    // is larger.
    float scaleBelow(vec3 wi, vec3 wo) const;

  private:
    // Returns the integral of f cosθi over the hemisphere for a white sheen, undivided.
    float albedo(float cosine) const;

    static constexpr int kAlbedos = 64;

    vec3 mColor;
    float mAlpha;
    std::array<float, kAlbedos> mAlbedos; // at even steps of the square root of the cosine
};

} // namespace relume
