// Code that the microfacet models share. Directions are in the local frame, lifted above the horizon.
#pragma once

#include "engine/math/vector.h"

#include <algorithm>
#include <cmath>

namespace relume {

// The least width of the models that take a roughness from glTF: a narrower lobe falls between a map's
// texels.
constexpr float kMinAlpha = 0.02f;

// The half vector of two directions above the horizon, and the cosine of either to it: |ωi + ωo| / 2, which
// rounds alike whichever comes first.
struct HalfVector {
    vec3 direction;
    float cosine;

    HalfVector(vec3 wi, vec3 wo) {
        const vec3 sum = wi + wo;
        const float length = glm::length(sum);
        direction = sum / length;
        cosine = std::min(length / 2, 1.0f);
    }
};

// Schlick's Fresnel term (1994) is F0 + (1 - F0) w, with w = (1 - cosine)⁵.
inline float schlickWeight(float cosine) {
    const float rest = 1.0f - cosine, squared = rest * rest;
    return squared * squared * rest;
}

inline vec3 schlickFresnel(vec3 atNormal, float cosine) {
    return atNormal + (1.0f - atNormal) * schlickWeight(cosine);
}

// A Lambertian base that receives and sends what the Fresnel term of its coat lets through.
inline vec3 coatedBase(vec3 diffuse, vec3 coatAtNormal, vec3 wi, vec3 wo) {
    const vec3 through =
        (1.0f - schlickFresnel(coatAtNormal, wi.z)) * (1.0f - schlickFresnel(coatAtNormal, wo.z));
    return diffuse * through / kPi;
}

// The GGX microfacets of widths αu along s and αv along t.
struct Ggx {
    float alphaU, alphaV;

    // Walter et al. 2007, equation 33, stretched as Heitz 2014, equation 85; written without a difference of
    // nearly equal numbers.
    float distribution(vec3 half) const {
        const float area = alphaU * alphaV, ratio = alphaU / alphaV;
        const float root = half.x * half.x / ratio + half.y * half.y * ratio + area * half.z * half.z;
        return area / (kPi * root * root);
    }

    // G / (4 cosθi cosθo), masking and shadowing correlated by height: Heitz 2014, equations 86 and 99.
    float visibility(vec3 wi, vec3 wo) const { return 0.5f / (wo.z * stretched(wi) + wi.z * stretched(wo)); }

  private:
    float stretched(vec3 w) const {
        const float x = alphaU * w.x, y = alphaV * w.y;
        return std::sqrt(x * x + y * y + w.z * w.z);
    }
};

} // namespace relume
