// The analytic BRDF models, one file each: from checked parameters to a BRDF.
#pragma once

#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_parameters.h"

#include <algorithm>

namespace relume {

// {"albedo": a} : f = a / π. Default 0.5.
std::unique_ptr<Brdf> makeDiffuse(MaterialParameters& parameters);

// {"kd": a, "ks": a, "nu": n, "nv": n}: Ashikhmin and Shirley, "An Anisotropic Phong BRDF Model", Journal
// of Graphics Tools 5(2), 2000. kd is the albedo of the diffuse base, ks the specular reflectance at
// normal incidence, nu and nv the exponents along s and t. Default: kd .5, ks .75, nu 10, nv 100.
std::unique_ptr<Brdf> makeAshikhminShirley(MaterialParameters& parameters);

// {"diffuse": a, "lobes": [{"cx": c, "cy": c, "cz": c, "n": n}, …]}: Lafortune, Foo, Torrance and
// Greenberg, "Non-Linear Approximation of Reflectance Functions", SIGGRAPH 1997:
// f = a / π + Σ max(0, cx ωi.x ωo.x + cy ωi.y ωo.y + cz ωi.z ωo.z)ⁿ. A fit to measurements, which bounds
// no energy.
std::unique_ptr<Brdf> makeLafortune(MaterialParameters& parameters);

// {"diffuse": a, "f0": F or "index": η, "roughness": α}: a Lambertian base under a rough dielectric. The
// specular part is Cook and Torrance's (1982) with the GGX distribution of width α (Walter et al. 2007)
// and Smith's height-correlated masking (Heitz 2014); the base receives and sends what Schlick's Fresnel
// term lets through: f = a (1 - F(ωi.z)) (1 - F(ωo.z)) / π + D F G / (4 ωi.z ωo.z), with energy ≤ 1.
// Default: diffuse .5, f0 .04, roughness .2.
std::unique_ptr<Brdf> makePlastic(MaterialParameters& parameters);

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

// Fresnel reflectance at the cosine of the angle of incidence (Schlick 1994).
inline vec3 schlickFresnel(vec3 atNormal, float cosine) {
    const float rest = 1.0f - cosine, squared = rest * rest;
    return atNormal + (1.0f - atNormal) * (squared * squared * rest);
}

} // namespace relume
