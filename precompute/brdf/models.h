// The analytic BRDF models, one file each. Every function reads a model's parameters and makes its BRDF.
#pragma once

#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_parameters.h"

namespace relume {

// {"albedo": a}: f = a / π. Default: albedo .5.
std::unique_ptr<Brdf> makeDiffuse(MaterialParameters& parameters);

// {"albedo": a, "sigma": σ}: Oren and Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994,
// as improved by Fujii, "A tiny improvement of Oren-Nayar reflectance model", 2012: f = a A (1 + r s / t) /
// π, with s = cos(φi - φo) sinθi sinθo, t = max(cosθi, cosθo) where s > 0 and 1 elsewhere. r is the ratio B /
// A of the two terms of the 1994 paper (equation 30) at σ degrees; A = 1 / (1 + r (1/2 - 2 / 3π)) keeps every
// albedo at most a (Portsmouth, Kutz and Hill, "EON", JCGT 2025, section 2). Default: albedo .5, sigma 20.
std::unique_ptr<Brdf> makeOrenNayar(MaterialParameters& parameters);

// {"kd": a, "ks": a, "exponent": n}: Lafortune and Willems, "Using the Modified Phong Reflectance Model for
// Physically Based Rendering", 1994: f = kd / π + ks (n + 2) cosⁿα / 2π, with α from the mirror direction.
// No albedo exceeds 1, since kd + ks ≤ 1 is required. Default: kd .4, ks .3, exponent 30.
std::unique_ptr<Brdf> makePhong(MaterialParameters& parameters);

// {"kd": a, "ks": a, "nu": n, "nv": n}: Ashikhmin and Shirley, "An Anisotropic Phong BRDF Model", Journal
// of Graphics Tools 5(2), 2000. kd is the albedo of the diffuse base, ks the specular reflectance at
// normal incidence, nu and nv the exponents along s and t. Default: kd .5, ks .75, nu 10, nv 100.
std::unique_ptr<Brdf> makeAshikhminShirley(MaterialParameters& parameters);

// {"diffuse": a, "lobes": [{"cx": c, "cy": c, "cz": c, "n": n}, …]}: Lafortune, Foo, Torrance and Greenberg,
// "Non-Linear Approximation of Reflectance Functions", SIGGRAPH 1997: f = a / π + Σ max(0, cx ωi.x ωo.x + cy
// ωi.y ωo.y + cz ωi.z ωo.z)ⁿ. It fits measurements and does not enforce energy conservation; the presets'
// albedos stay below one at every angle.
std::unique_ptr<Brdf> makeLafortune(MaterialParameters& parameters);

// {"diffuse": a, "f0": F, "roughness": m}: Cook and Torrance, "A Reflectance Model for Computer Graphics",
// ACM Transactions on Graphics 1(1), 1982: Beckmann distribution of slope m and V-cavity masking, over a
// diffuse base coupled as in makePlastic(). The specular part is D F G / (4 cosθi cosθo), normalized as in
// Walter et al. 2007; the 1982 paper has π instead of 4. Default: diffuse .3, f0 .04, roughness .3.
std::unique_ptr<Brdf> makeCookTorrance(MaterialParameters& parameters);

// {"f0": F, "roughness_u": α, "roughness_v": α}: a bare conductor of GGX microfacets (Walter et al., EGSR
// 2007) of widths α along s and t, with height-correlated masking (Heitz, "Understanding the
// Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014) and Schlick's Fresnel term. Light
// scattered between microfacets is lost. Default: f0 .9, roughness .2 both ways.
std::unique_ptr<Brdf> makeGgx(MaterialParameters& parameters);

// {"base_color": c, "metallic": m, "roughness": r}: glTF 2.0, appendix B, with α = max(r², .02), since
// narrower lobes fall between the texels of any map. f = (1 - m) (base + interface) + m metal. The base is
// c (1 - F(cosθi)) (1 - F(cosθo)) / (1 - F(1)) / π; the appendix' sample code instead weights it by
// 1 - F(h·ωo), with which a smooth white material reflects 1.6 times what it receives at grazing angles.
// Default: base_color .8, metallic 0, roughness .5. Khronos' material extensions are parameters as well, none
// of which has an effect by default: ior, specular, specular_color, anisotropy, anisotropy_rotation
// (degrees), sheen_color, sheen_roughness, clearcoat, clearcoat_roughness (docs/materials.md).
std::unique_ptr<Brdf> makeGltf(MaterialParameters& parameters);

// {"diffuse": a, "f0": F or "index": η, "roughness": α}: a Lambertian base under a rough dielectric. The
// specular part is Cook and Torrance's (1982) with the GGX distribution of width α (Walter et al. 2007) and
// Smith's height-correlated masking (Heitz 2014). The base receives and sends what Schlick's Fresnel term
// lets through. f = a (1 - F(ωi.z)) (1 - F(ωo.z)) / π + D F G / (4 ωi.z ωo.z), whose albedo is at most 1.
// Default: diffuse .5, f0 .04, roughness .2.
std::unique_ptr<Brdf> makePlastic(MaterialParameters& parameters);

} // namespace relume
